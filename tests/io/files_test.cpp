// SPDX-License-Identifier: MIT
#include "root_sph/io/files.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/frame_csv.hpp"
#include "root_sph/io/series.hpp"
#include "tests/io/temporary_folder.hpp"

namespace rootsoil {
namespace {

using test::TemporaryFolder;

// The lock belongs to an open file, so a second process is not needed to meet it, but one is what it is for.
int exit_status_in_a_child(const std::function<int()>& action) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(action());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Files, AreReplacedAsAWhole) {
  const TemporaryFolder folder;
  write_text_atomically(folder / "a", "old");
  write_text_atomically(folder / "a", std::string("new\0content", 11));
  EXPECT_EQ(read_whole_file(folder / "a"), std::string("new\0content", 11));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.tmp"));
}

TEST(Files, OnAFullDiskTheOldContentStays) {
  const TemporaryFolder folder;
  write_text_atomically(folder / "a", "old");
  const test::FullDisk full(10);
  test::expect_contains(test::message_of<FileError>([&] { write_text_atomically(folder / "a", "longer than that"); }),
                        "cannot be written: File too large");
  EXPECT_EQ(read_whole_file(folder / "a"), "old");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.tmp"));
}

TEST(Files, WhatCannotBeReadOrWrittenIsNamed) {
  const TemporaryFolder folder;
  test::expect_contains(test::message_of<FileError>([&] { write_text_atomically(folder / "no/such", "x"); }),
                        "no/such: cannot be written: No such file or directory");
  for (const auto& [path, reason] : {std::pair(folder / "none", "No such file"), {folder.path(), "Is a directory"}}) {
    const std::string message = test::message_of<FileError>([&] { read_whole_file(path); });
    test::expect_contains(message, reason);
    test::expect_contains(message, "\n  to do:   check the path");
  }
}

TEST(RunFolder, IsCreatedWithItsParents) {
  const TemporaryFolder folder;
  const RunFolder run = claim_run_folder(folder / "a/b", false);
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b"));
  EXPECT_EQ(run.path(), folder / "a/b");
}

TEST(RunFolder, AnyTraceOfARunKeepsOthersOut) {
  for (const char* trace : {"summary.json", "run.h5", "checkpoint.h5", "history.csv", "scene.toml", "frames"}) {
    const TemporaryFolder folder;
    write_text_atomically(folder / trace, "precious");
    const std::string message = test::message_of<InputError>([&] { (void)claim_run_folder(folder.path(), false); });
    test::expect_contains(message, trace);
    test::expect_contains(message, "--resume");
    test::expect_contains(message, "--out");
    EXPECT_EQ(read_whole_file(folder / trace), "precious");
  }
}

TEST(RunFolder, SaysWhichRunIsThere) {
  const TemporaryFolder folder;
  SeriesWriter writer(folder.path(), {{"scene", "case1_isotropic"}});
  writer.write({2.5, 10, {}});
  const std::string message = test::message_of<InputError>([&] { (void)claim_run_folder(folder.path(), false); });
  test::expect_contains(message, "scene 'case1_isotropic', 1 frames up to 2.5 h");
}

TEST(RunFolder, ResumeNeedsACheckpoint) {
  const TemporaryFolder folder;
  test::expect_contains(test::message_of<InputError>([&] { (void)claim_run_folder(folder / "new", true); }),
                        "no checkpoint");
  EXPECT_FALSE(std::filesystem::exists(folder / "new"));
  write_text_atomically(folder / "checkpoint.h5", "x");
  EXPECT_NO_THROW((void)claim_run_folder(folder.path(), true));
}

TEST(RunFolder, TwoProcessesNeverShareOne) {
  const TemporaryFolder folder;
  const auto claim = [&] {
    try {
      (void)claim_run_folder(folder.path(), false);
      return 0;
    } catch (const InputError& error) {
      return std::string(error.what()).find("another process") != std::string::npos ? 1 : 2;
    }
  };
  {
    const RunFolder run = claim_run_folder(folder.path(), false);
    EXPECT_EQ(exit_status_in_a_child(claim), 1);
  }
  EXPECT_EQ(exit_status_in_a_child(claim), 0);
}

TEST(RunFolder, WhatCannotBeCreatedOrWrittenIsAFileError) {
  const TemporaryFolder folder;
  write_text_atomically(folder / "file", "x");
  test::expect_contains(test::message_of<FileError>([&] { (void)claim_run_folder(folder / "file/run", false); }),
                        "cannot be created");
  // /proc refuses even the superuser
  test::expect_contains(test::message_of<FileError>([&] { (void)claim_run_folder("/proc/self", false); }),
                        "cannot be written");
}

TEST(FrameCsv, ARowACellWithEveryComponentNamed) {
  const TemporaryFolder folder;
  const Frame frame{0.0,
                    0,
                    {{"cell_id", "1", "", 1, std::vector<std::int64_t>{7, 8}},
                     {"position", "mm", "", 3, std::vector<double>{0.1, 2, 3, 4, 5, 1.0 / 3.0}},
                     {"stress", "MPa", "", 6, std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}},
                     {"density", "1", "", 1, std::vector<double>{1e-300, -0.0}}}};
  write_frame_csv(folder / "cells.csv", frame);
  EXPECT_EQ(read_whole_file(folder / "cells.csv"),
            "cell_id,position_x,position_y,position_z,stress_xx,stress_yy,stress_zz,stress_xy,stress_yz,stress_xz,"
            "density\n"
            "7,0.1,2,3,1,2,3,4,5,6,1e-300\n"
            "8,4,5,0.3333333333333333,7,8,9,10,11,12,-0\n");
}

}  // namespace
}  // namespace rootsoil
