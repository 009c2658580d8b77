// SPDX-License-Identifier: MIT
#include "root_sph/core/errors.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <utility>

namespace rootsoil {

std::string format_input_problem(const InputProblem& p) {
  std::string text;
  if (!p.file.empty()) {
    text += p.line > 0 ? fmt::format("{}:{}: ", p.file, p.line) : fmt::format("{}: ", p.file);
  }
  if (!p.key.empty()) text += p.key + ": ";
  text += p.what;
  if (!p.given.empty()) text += fmt::format("\n  given:   {}", p.given);
  if (!p.allowed.empty()) text += fmt::format("\n  allowed: {}", p.allowed);
  if (!p.remedy.empty()) text += fmt::format("\n  to do:   {}", p.remedy);
  return text;
}

InputError::InputError(InputProblem problem)
    : Error(ExitStatus::bad_input, format_input_problem(problem)), problem_(std::move(problem)) {}

FileError::FileError(const std::string& problem, const std::string& remedy)
    : Error(ExitStatus::file_trouble, remedy.empty() ? problem : fmt::format("{}\n  to do:   {}", problem, remedy)),
      problem_(problem),
      remedy_(remedy) {}

std::string file_remedy(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "make room on the disk, or raise the limit; a run then goes on by --resume";
    case EACCES:
    case EPERM:
    case EROFS:
      return "check the permissions of the file and its folder, or take another place";
    case ENOENT:
    case ENOTDIR:
    case EISDIR:
    case EEXIST:
      return "check the path: every part of it but the last must be a folder that is there";
    default:
      return "check the path and the disk; a run then goes on by --resume";
  }
}

void assertion_failed(const char* expression, const char* file, int line) {
  throw std::logic_error(fmt::format("internal error: {} is false ({}:{}); please report it", expression, file, line));
}

}  // namespace rootsoil
