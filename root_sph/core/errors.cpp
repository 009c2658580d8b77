// SPDX-License-Identifier: MIT
#include "root_sph/core/errors.hpp"

#include <fmt/format.h>

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

void assertion_failed(const char* expression, const char* file, int line) {
  throw std::logic_error(fmt::format("internal error: {} is false ({}:{}); please report it", expression, file, line));
}

}  // namespace rootsoil
