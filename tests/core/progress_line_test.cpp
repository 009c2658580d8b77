// SPDX-License-Identifier: MIT
// Progress where there is no terminal: whole lines, at their pace.
#include "root_sph/core/progress_line.hpp"

#include <gtest/gtest.h>

namespace rootsoil {
namespace {

using namespace std::chrono_literals;

/// What goes to the standard error, which is a file meanwhile.
template <class Body>
std::string said(Body&& body) {
  ::testing::internal::CaptureStderr();
  body();
  return ::testing::internal::GetCapturedStderr();
}

TEST(ProgressLine, IsWholeLinesWithoutATerminal) {
  const std::string text = said([] {
    ProgressLine line(false, 0ms);
    line.show("one");
    line.show("two");
  });
  EXPECT_EQ(text, "one\ntwo\n");
}

TEST(ProgressLine, KeepsItsPaceWithoutATerminal) {
  const std::string text = said([] {
    ProgressLine line(false, 1h);
    EXPECT_FALSE(line.due());  // the first comes after ten seconds
    line.show("one");
  });
  EXPECT_EQ(text, "");
}

TEST(ProgressLine, SaysNothingWhenQuiet) {
  EXPECT_EQ(said([] { ProgressLine(true, 0ms).show("one"); }), "");
}

}  // namespace
}  // namespace rootsoil
