// SPDX-License-Identifier: MIT
#include "root_sph/io/history.hpp"

#include <array>
#include <charconv>
#include <limits>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"
#include "tests/io/temporary_folder.hpp"

namespace rootsoil {
namespace {

using test::TemporaryFolder;

const std::vector<std::string> columns = {"time_h", "cells", "tip_x_mm"};

void append(HistoryWriter& history, double time_h, double cells, double tip_mm) {
  const std::array row = {time_h, cells, tip_mm};
  history.append(row);
}

TEST(History, ARowIsOnTheDiskAtOnceWithRoundTripPrecision) {
  const TemporaryFolder folder;
  HistoryWriter history(folder / "history.csv", columns);
  EXPECT_EQ(read_whole_file(folder / "history.csv"), "time_h,cells,tip_x_mm\n");
  append(history, 0.0, 12.0, 1.0 / 3.0);
  const std::string text = read_whole_file(folder / "history.csv");
  EXPECT_EQ(text, "time_h,cells,tip_x_mm\n0,12,0.3333333333333333\n");
  const std::size_t last = text.rfind(',') + 1;
  double value = 0.0;
  std::from_chars(text.data() + last, text.data() + text.size(), value);
  EXPECT_EQ(value, 1.0 / 3.0);
}

TEST(History, WhatIsNotKnownIsEmpty) {
  const TemporaryFolder folder;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  {
    HistoryWriter history(folder / "history.csv", columns);
    append(history, 0.0, unknown, 1.0);
    append(history, 0.1, 1.0, unknown);
  }
  const HistoryWriter history(folder / "history.csv", columns, 1.0);
  EXPECT_EQ(read_whole_file(folder / "history.csv"), "time_h,cells,tip_x_mm\n0,,1\n0.1,1,\n");
}

TEST(History, GoesOnWithoutLaterAndHalfRows) {
  const TemporaryFolder folder;
  const auto path = folder / "history.csv";
  {
    HistoryWriter history(path, columns);
    for (int i = 0; i < 5; ++i) append(history, 0.1 * i, i, i);
  }
  {
    HistoryWriter history(path, columns, 0.1 * 3);
    append(history, 0.4, 4, 4);
  }
  const std::string whole = "time_h,cells,tip_x_mm\n0,0,0\n0.1,1,1\n0.2,2,2\n0.30000000000000004,3,3\n0.4,4,4\n";
  EXPECT_EQ(read_whole_file(path), whole);
  write_text_atomically(path, whole + "0.5,5");
  const HistoryWriter history(path, columns, 10.0);
  EXPECT_EQ(read_whole_file(path), whole);
}

TEST(History, OtherColumnsAndBrokenRowsAreRefused) {
  const TemporaryFolder folder;
  const auto path = folder / "history.csv";
  write_text_atomically(path, "time_h,cells\n0,1\n");
  test::expect_contains(test::message_of<FileError>([&] { HistoryWriter(path, columns, 1.0); }),
                        "given:   time_h,cells");
  write_text_atomically(path, "time_h,cells,tip_x_mm\n0,1,1\n?,2,2\n");
  test::expect_contains(test::message_of<FileError>([&] { HistoryWriter(path, columns, 1.0); }), "history.csv:3:");
}

TEST(History, OnAFullDiskNoHalfRowStays) {
  const TemporaryFolder folder;
  const auto path = folder / "history.csv";
  HistoryWriter history(path, columns);
  append(history, 0, 1, 1);
  const std::string before = read_whole_file(path);
  {
    const test::FullDisk full(before.size() + 4);
    test::expect_contains(test::message_of<FileError>([&] { append(history, 1, 1.23456789, 1); }), "history.csv");
    EXPECT_EQ(read_whole_file(path), before);
  }
  append(history, 1, 2, 3);
  EXPECT_EQ(read_whole_file(path), before + "1,2,3\n");
}

}  // namespace
}  // namespace rootsoil
