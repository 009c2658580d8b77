// SPDX-License-Identifier: MIT
// The process, without YADE: a driver that fails in every way a real one can (fake_driver.py).
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <set>

#include "tests/soil_coupling/support.hpp"

namespace rootsoil {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Process : public testing::Test {
 protected:
  SoilProcessOptions fake(const char* how) {
    setenv("FAKE_SOIL", how, 1);
    SoilProcessOptions options;
    options.driver = ROOTSOIL_SOURCE_DIR "/tests/soil_coupling/fake_driver.py";
    options.patience.start_s = 20.0;
    options.patience.step_at_least_s = 0.5;
    options.patience.step_medians = 1.0;
    return options;
  }
  YadeSoil soil(const char* how) { return {listed_, {}, fake(how)}; }
  test::Folder folder_;
  SoilRecipe listed_ = test::listed_grains({{{1.5, 1.5, 0}, 0.15}});
};

TEST_F(Process, ExchangesColumnsOfAnyLength) {
  YadeSoil s = soil("");
  EXPECT_EQ(s.process().engine_version(), "fake");
  std::int64_t interval = 0;
  for (const int markers : {1, 5000, 0, 40000, 3}) {  // the block must grow twice
    const SurfaceForces f = s.advance(test::row_of_markers(interval++, markers, 1.0, 0.25));
    ASSERT_EQ(f.mean_N.size(), static_cast<std::size_t>(markers));
    for (int k = 0; k < markers; ++k) {
      ASSERT_EQ(f.mean_N[k], (Vec3{-0.25, 0, 0}));
      ASSERT_EQ(f.contact_stiffness_N_mm[k], k + 0.1);
    }
    EXPECT_EQ(f.numbers.at("soil_rows"), markers);
  }
}

TEST_F(Process, SaysHowItEnded) {
  const std::pair<const char*, const char*> cases[] = {{"kill", "was killed by signal 9"},
                                                       {"crash", "was killed by signal 11"},
                                                       {"exit", "ended with status 7"},
                                                       {"throw", "ZeroDivisionError"},
                                                       {"stop", "(it is stopped)"},
                                                       {"late", "gave no answer for 0.5 s"},
                                                       {"nan", "a force is not finite"},
                                                       {"nan_number", "can't be read"},
                                                       {"traceback", "ValueError: no such grain"},
                                                       {"sequence", "an answer to message"},
                                                       {"rows", "2 rows for interval 1 instead of 3"}};
  for (const auto& [how, words] : cases) {
    SCOPED_TRACE(how);
    YadeSoil s = soil(how);
    s.advance(test::row_of_markers(0, 3, 0, 0.1));
    const pid_t pid = s.process().pid();
    const std::string text = test::message_of<SoilError>([&] { s.advance(test::row_of_markers(1, 3, 0.1, 0.1)); });
    EXPECT_THAT(text, AllOf(HasSubstr(words), HasSubstr("in interval 1"), HasSubstr("checkpoint")));
    EXPECT_THAT(text, Not(HasSubstr("Traceback")));
    if (std::string(how) == "kill") {
      EXPECT_THAT(text, HasSubstr("it said last:\ninterval 0\ninterval 1"));
    }
    if (s.process().protocol().state() == SoilState::failed) {
      EXPECT_FALSE(test::runs(pid));
    }
  }
}

TEST_F(Process, AFailureAtTheStartIsToldApart) {
  EXPECT_THAT(test::message_of<SoilError>([&] { soil("missing"); }), HasSubstr("YADE can't be imported"));
  EXPECT_THAT(test::message_of<SoilError>([&] { soil("version"); }),
              AllOf(HasSubstr("speaks version 99, this program version 2"), HasSubstr("while it started")));
  SoilProcessOptions options = fake("mute");
  options.patience.start_s = 0.3;
  EXPECT_THAT(test::message_of<SoilError>([&] { SoilProcess p(options); }),
              HasSubstr("gave no answer for 0.3 s while it started"));
  options.python = "/nowhere/python3";
  EXPECT_THAT(test::message_of<SoilError>([&] { SoilProcess p(options); }), HasSubstr("/nowhere/python3"));
}

TEST_F(Process, WhatItRefusesIsTheUsersInput) {
  YadeSoil s = soil("refuse");
  s.advance(test::row_of_markers(0, 3, 0, 0.1));
  const std::string text = test::message_of<InputError>([&] { s.advance(test::row_of_markers(1, 3, 0, 0.1)); });
  EXPECT_THAT(text, AllOf(HasSubstr("soil.box_to_mm: no room"), HasSubstr("to do:   a wider box")));
}

TEST_F(Process, LongTasksSayHowFarTheyAre) {
  SoilProcessOptions options = fake("progress");
  std::vector<std::string> said;
  options.progress = [&](const std::string& text) { said.push_back(text); };
  YadeSoil s(listed_, {}, options);
  EXPECT_THAT(said, testing::ElementsAre("part 0", "part 1", "part 2"));
}

TEST_F(Process, EndsWithItsObject) {
  pid_t pid = 0;
  const auto start = std::chrono::steady_clock::now();
  {
    YadeSoil s = soil("");
    pid = s.process().pid();
    EXPECT_TRUE(test::runs(pid));
  }
  EXPECT_FALSE(test::runs(pid));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << "it stopped when asked";
}

TEST_F(Process, EndsWhenTheProgramIsKilled) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t program = fork();
  if (program == 0) {
    YadeSoil s = soil("");
    const pid_t pid = s.process().pid();
    [[maybe_unused]] const ssize_t written = write(ends[1], &pid, sizeof(pid));
    pause();
    _exit(0);
  }
  pid_t soil_process = 0;
  ASSERT_EQ(read(ends[0], &soil_process, sizeof(soil_process)), static_cast<ssize_t>(sizeof(soil_process)));
  EXPECT_TRUE(test::runs(soil_process));
  kill(program, SIGKILL);
  waitpid(program, nullptr, 0);
  for (int k = 0; k < 100 && test::runs(soil_process); ++k) usleep(50'000);
  EXPECT_FALSE(test::runs(soil_process));
  close(ends[0]);
  close(ends[1]);
}

TEST_F(Process, LeavesNothingBehind) {
  const auto names = [](const char* folder) {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().filename().string().find("rootsoil") != std::string::npos) found.insert(entry.path().filename());
    }
    return found;
  };
  const auto descriptors = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
  };
  const auto memory = names("/dev/shm");
  const auto open_before = descriptors();
  {
    YadeSoil s = soil("kill");
    s.advance(test::row_of_markers(0, 3, 0, 0.1));
    EXPECT_THROW(s.advance(test::row_of_markers(1, 3, 0, 0.1)), SoilError);
  }
  EXPECT_EQ(names("/dev/shm"), memory);
  EXPECT_EQ(descriptors(), open_before);
}

}  // namespace
}  // namespace rootsoil
