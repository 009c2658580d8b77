// SPDX-License-Identifier: MIT
// The ways a run can end early. Each kind has an exit status that scripts rely on.
#pragma once

#include <stdexcept>
#include <string>

namespace rootsoil {

enum class ExitStatus : int {
  done = 0,
  bad_input = 2,      ///< the user's input is wrong
  unphysical = 3,     ///< the run became unphysical and stopped
  soil_failed = 4,    ///< the soil process failed
  file_trouble = 5,   ///< disk or file trouble
  interrupted = 130,  ///< a signal; checkpoint written
};

/// Base of everything that ends a run with a message for its user.
class Error : public std::runtime_error {
 public:
  Error(ExitStatus status, const std::string& message) : std::runtime_error(message), status_(status) {}
  ExitStatus status() const { return status_; }

 private:
  ExitStatus status_;
};

/// What a message about wrong input says. Empty parts are left out.
struct InputProblem {
  std::string file;     ///< path as the user gave it
  int line = 0;         ///< 1-based, 0 = unknown
  std::string key;      ///< e.g. "root.radius_mm"
  std::string what;     ///< what is wrong, one sentence without full stop
  std::string given;    ///< the value found
  std::string allowed;  ///< what would have been accepted
  std::string remedy;   ///< what to do
};

class InputError : public Error {
 public:
  explicit InputError(InputProblem problem);
  const InputProblem& problem() const { return problem_; }

 private:
  InputProblem problem_;
};

class UnphysicalError : public Error {
 public:
  explicit UnphysicalError(const std::string& message) : Error(ExitStatus::unphysical, message) {}
};

/// The soil process failed, or broke the protocol.
class SoilError : public Error {
 public:
  explicit SoilError(const std::string& message) : Error(ExitStatus::soil_failed, message) {}
};

class FileError : public Error {
 public:
  /// \param problem without full stop
  explicit FileError(const std::string& problem, const std::string& remedy = {});
  const std::string& problem() const { return problem_; }  ///< for whoever knows more, and says it all anew
  const std::string& remedy() const { return remedy_; }

 private:
  std::string problem_, remedy_;
};

/// What to do where the system refused to write or read a file, by its error number.
std::string file_remedy(int error_number);

/// "file:line: key: what (given: ..., allowed: ...). remedy"
std::string format_input_problem(const InputProblem& problem);

[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);

}  // namespace rootsoil

/// For our own mistakes, never for the user's: always on, cheap places only.
#define ROOTSOIL_ASSERT(expression) \
  ((expression) ? void(0) : ::rootsoil::assertion_failed(#expression, __FILE__, __LINE__))
