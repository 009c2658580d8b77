// SPDX-License-Identifier: MIT
#include "tests/physics/recorded.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

namespace rootsoil::physics {
namespace {

const char* const header = "test,quantity,error";

std::filesystem::path file() {
  return std::filesystem::path(ROOTSOIL_SOURCE_DIR) / "tests" / "physics" / "recorded_errors.csv";
}

/// "test,quantity" and the error.
using Records = std::map<std::string, double>;

Records read_records() {
  Records found;
  std::ifstream lines(file());
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    const std::size_t comma = line.rfind(',');
    found[line.substr(0, comma)] = std::stod(line.substr(comma + 1));
  }
  return found;
}

void write_records(const Records& records) {
  const std::filesystem::path whole = file(), part = whole.string() + ".part";
  std::ofstream lines(part);
  lines << header << '\n';
  for (const auto& [name, error] : records) lines << fmt::format("{},{:.3g}\n", name, error);
  lines.close();
  std::filesystem::rename(part, whole);
}

}  // namespace

void record(const std::string& name, double value) {
  std::printf("  %-44s %12.5g\n", name.c_str(), value);
  std::fflush(stdout);
  ::testing::Test::RecordProperty(name, std::to_string(value));
}

void expect_within_record(const std::string& quantity, double error, double noise) {
  record(quantity, error);
  const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string name = fmt::format("{}.{},{}", test->test_suite_name(), test->name(), quantity);
  Records records = read_records();
  if (std::getenv("ROOTSOIL_RECORD") != nullptr) {
    records[name] = std::abs(error);
    write_records(records);
    return;
  }
  if (!records.contains(name)) {
    ADD_FAILURE() << "'" << name << "' is not in recorded_errors.csv; $ROOTSOIL_RECORD=1 adds it";
    return;
  }
  constexpr double looser = 2.0, stale = 4.0;
  const double recorded = records.at(name);
  EXPECT_LE(std::abs(error), looser * std::max(recorded, noise)) << quantity << " got worse: recorded " << recorded;
  EXPECT_GE(stale * std::max(std::abs(error), noise), recorded)
      << quantity << " got better: renew the record by $ROOTSOIL_RECORD=1, so that it stays so";
}

}  // namespace rootsoil::physics
