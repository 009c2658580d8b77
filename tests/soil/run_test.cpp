// SPDX-License-Identifier: MIT
// Whole runs with a soil: files, resume, failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "root_sph/app/commands.hpp"
#include "root_sph/io/checkpoint.hpp"
#include "root_sph/io/files.hpp"
#include "root_sph/io/series.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/soil/soil_scene.hpp"

namespace rootsoil::soil_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

/// The scene, coupled to a soil: three windows an interval, so that checkpoints fall inside one.
Scene coupled(Scene scene) {
  SoilContactSection contact;
  contact.stiffness_predictor = true;
  contact.ramp_h = 0.0;
  contact.interval_h = 3 * scene.numerics.steps_a_window() * *scene.numerics.step_h;
  scene.all<SoilContactSection>().push_back(contact);
  return scene;
}

Scene contact_scene() {
  return coupled(parse_scene(scene_text, "test.toml",
                             {"scene.duration_h=0.4", "output.every_h=0.1", "output.checkpoint_every_h=0.1"}));
}

/// A plate that the root meets after some 0.06 h.
std::unique_ptr<SoilPort> plate_soil(const Scene& scene, const SoilStart&) {
  twins::HalfSpaceParameters p = plate(scene, 5.0);
  p.friction = 0.3;
  return std::make_unique<twins::HalfSpace>(p);
}

int run(const fs::path& out, const SoilMaker& make_soil, bool resume = false, std::optional<double> until_h = {},
        const Scene& scene = contact_scene()) {
  RunOptions options;
  options.out = out;
  options.threads = 1;
  options.resume = resume;
  options.until_h = until_h;
  options.quiet = true;
  return run_scene(scene, options, make_soil);
}

std::vector<std::string> state_files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.find(".state") != std::string::npos) names.push_back(name);
  }
  return names;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

/// A column of history.csv; not a number where a field is empty.
std::vector<double> column_of(const std::string& history, const std::string& name) {
  const std::vector<std::string> rows = split(history, '\n'), names = split(rows.at(0), ',');
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  std::vector<double> values;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const std::vector<std::string> fields = split(rows[k] + ",.", ',');  // the last field may be empty, too
    values.push_back(fields.at(at).empty() ? std::numeric_limits<double>::quiet_NaN() : std::stod(fields.at(at)));
  }
  return values;
}

void expect_same_run(const fs::path& a, const fs::path& b) {
  EXPECT_EQ(read_checkpoint(a / "checkpoint.h5"), read_checkpoint(b / "checkpoint.h5"));
  EXPECT_EQ(read_whole_file(a / "history.csv"), read_whole_file(b / "history.csv"));
  ASSERT_EQ(state_files(a), state_files(b));
  ASSERT_EQ(state_files(a).size(), 1u);  // only that of the last checkpoint
  EXPECT_EQ(read_whole_file(a / state_files(a)[0]), read_whole_file(b / state_files(b)[0]));
}

TEST(SoilRun, ResumesInContactBitForBit) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(folder / "whole", plate_soil), 0);
  const std::string history = read_whole_file(folder / "whole/history.csv");
  EXPECT_NE(history.find(",soil_tip_force_N,"), std::string::npos);
  EXPECT_NE(history.find(",soil_overlap_mm"), std::string::npos);
  for (const double until_h : {0.05, 0.2, 0.302}) {
    const fs::path parts = folder / std::to_string(until_h);
    ASSERT_EQ(run(parts, plate_soil, false, until_h), 0);
    ASSERT_EQ(run(parts, plate_soil, true), 0);
    expect_same_run(folder / "whole", parts);
  }
  const std::vector<FrameInfo> frames = list_frames(folder / "whole/run.h5");
  ASSERT_EQ(frames.size(), 5u);
  const auto& infos = frames.back().tables;
  const auto markers = std::find_if(infos.begin(), infos.end(), [](const auto& t) { return t.name == "markers"; });
  ASSERT_NE(markers, infos.end());
  const Frame last = read_frame(folder / "whole/run.h5", 4);
  const auto& columns = last.tables.at(static_cast<std::size_t>(markers - infos.begin())).columns;
  const auto force = std::find_if(columns.begin(), columns.end(), [](const auto& c) { return c.name == "force"; });
  ASSERT_NE(force, columns.end());
  EXPECT_EQ(force->unit, "N");
  double sum = 0.0;
  const auto& values = std::get<std::vector<double>>(force->values);
  for (std::size_t m = 0; 3 * m < values.size(); ++m) sum -= values[3 * m];
  EXPECT_GT(sum, 0.1);
}

/// Half of the root sleeps before it meets the plate, and is woken by it.
TEST(SoilRun, ResumesAsleepBitForBit) {
  const Scene scene =
      coupled(parse_scene(text_with_inertia + "[sleep]\n", "test.toml",
                          {"scene.duration_h=0.4", "root.length_mm=2.4", "numerics.window_steps=5",
                           "output.every_h=0.02", "output.checkpoint_every_h=0.1", "numerics.step_h=2e-4"}));
  const TemporaryFolder folder;
  ASSERT_EQ(run(folder / "whole", plate_soil, false, {}, scene), 0);
  for (const double until_h : {0.022, 0.061, 0.2, 0.302}) {
    const fs::path parts = folder / std::to_string(until_h);
    ASSERT_EQ(run(parts, plate_soil, false, until_h, scene), 0);
    ASSERT_EQ(run(parts, plate_soil, true, {}, scene), 0);
    expect_same_run(folder / "whole", parts);
  }
  const std::string history = read_whole_file(folder / "whole/history.csv");
  const std::vector<double> resting = column_of(history, "cells_at_rest"), woken = column_of(history, "times_woken");
  EXPECT_GT(*std::max_element(resting.begin(), resting.end()), 100.0);
  EXPECT_GE(woken.back(), 1.0);
}

TEST(SoilRun, WithoutASoilNothingOfItExists) {
  const TemporaryFolder folder;
  Scene scene = contact_scene();
  scene.all<SoilContactSection>().clear();
  const auto unwanted = [](const Scene&, const SoilStart&) -> std::unique_ptr<SoilPort> {
    throw std::logic_error("no effect called for a soil");
  };
  ASSERT_EQ(run(folder / "none", {}, false, {}, scene), 0);
  ASSERT_EQ(run(folder / "offered", unwanted, false, {}, scene), 0);
  EXPECT_EQ(read_checkpoint(folder / "none/checkpoint.h5"), read_checkpoint(folder / "offered/checkpoint.h5"));
  EXPECT_EQ(read_whole_file(folder / "none/history.csv"), read_whole_file(folder / "offered/history.csv"));
  EXPECT_EQ(read_whole_file(folder / "none/history.csv").find("soil"), std::string::npos);
  EXPECT_EQ(read_whole_file(folder / "none/summary.json").find("\"soil"), std::string::npos);
  EXPECT_TRUE(state_files(folder / "none").empty());
}

/// A plate made of two grains that touch each other, the root and a wall.
class Grains final : public SoilPort {
 public:
  explicit Grains(const twins::HalfSpaceParameters& p) : plate_(p) {}
  SurfaceForces advance(const SurfaceMotion& motion) override { return plate_.advance(motion); }
  std::vector<std::string> number_names() const override { return plate_.number_names(); }
  void save(const fs::path& file) override { plate_.save(file); }
  void load(const fs::path& file) override { plate_.load(file); }
  SoilSnapshot snapshot() override {
    return {.id = {7, 9},
            .position_mm = {{1, 2, 3}, {4, 5, 6}},
            .velocity_mm_h = {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}},
            .radius_mm = {0.5, 0.25},
            .contacts = {2, 2},
            .stress_MPa = {{1, 2, 3, 23, 13, 12}, {4, 5, 6, 56, 46, 45}},
            .contact_position_mm = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
            .contact_force_N = {{-1, 0, 0}, {-2, 0.5, 0}, {-3, 0, 0.25}},
            .contact_ids = {{7, -1}, {7, 9}, {9, -2}}};
  }

 private:
  twins::HalfSpace plate_;
};

TEST(SoilRun, FramesHoldGrainsAndContacts) {
  const TemporaryFolder folder;
  const auto grains = [](const Scene& scene, const SoilStart&) { return std::make_unique<Grains>(plate(scene, 5.0)); };
  ASSERT_EQ(run(folder / "run", grains, false, 0.1), 0);
  ASSERT_EQ(read_frame(folder / "run/run.h5", 0).tables.size(),
            2u);  // before the root is put in, markers and the closed form only
  const Frame frame = read_frame(folder / "run/run.h5", 1);
  const auto column = [&](const std::string& set, const std::string& name) -> const FrameColumn& {
    const auto table =
        std::find_if(frame.tables.begin(), frame.tables.end(), [&](const auto& p) { return p.name == set; });
    if (table == frame.tables.end()) throw std::runtime_error("no table " + set);
    const auto& columns = table->columns;
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
    if (found == columns.end()) throw std::runtime_error("no column " + name);
    return *found;
  };
  const auto reals = [&](const std::string& set, const std::string& name) {
    return std::get<std::vector<double>>(column(set, name).values);
  };
  const auto whole = [&](const std::string& set, const std::string& name) {
    return std::get<std::vector<std::int64_t>>(column(set, name).values);
  };
  using Reals = std::vector<double>;
  using Whole = std::vector<std::int64_t>;
  EXPECT_EQ(reals("grains", "position"), (Reals{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(reals("grains", "velocity"), (Reals{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}));
  EXPECT_EQ(reals("grains", "radius"), (Reals{0.5, 0.25}));
  EXPECT_EQ(reals("grains", "stress"), (Reals{1, 2, 3, 12, 23, 13, 4, 5, 6, 45, 56, 46}));  // xx yy zz xy yz xz
  EXPECT_EQ(whole("grains", "contacts"), (Whole{2, 2}));
  EXPECT_EQ(whole("grains", "grain_id"), (Whole{7, 9}));
  EXPECT_EQ(reals("soil_contacts", "position"), (Reals{1, 0, 0, 2, 0, 0, 3, 0, 0}));
  EXPECT_EQ(reals("soil_contacts", "force"), (Reals{-1, 0, 0, -2, 0.5, 0, -3, 0, 0.25}));
  EXPECT_EQ(whole("soil_contacts", "first_id"), (Whole{7, 7, 9}));
  EXPECT_EQ(whole("soil_contacts", "second_id"), (Whole{-1, 9, -2}));
  const std::string xdmf = read_whole_file(folder / "run/run.xmf");
  EXPECT_NE(xdmf.find("/grains/radius"), std::string::npos);
  EXPECT_NE(xdmf.find("/soil_contacts/force"), std::string::npos);
}

/// A plate that fails in one interval.
class Failing final : public SoilPort {
 public:
  Failing(const twins::HalfSpaceParameters& p, bool throws) : plate_(p), throws_(throws) {}
  SurfaceForces advance(const SurfaceMotion& motion) override {
    SurfaceForces forces = plate_.advance(motion);
    if (motion.time_h > 0.25 && throws_) throw Error(ExitStatus::soil_failed, "the soil fell over");
    if (motion.time_h > 0.25) forces.mean_N[0][0] = std::nan("");
    return forces;
  }
  std::vector<std::string> number_names() const override { return plate_.number_names(); }
  void save(const fs::path& file) override { plate_.save(file); }
  void load(const fs::path& file) override { plate_.load(file); }

 private:
  twins::HalfSpace plate_;
  bool throws_;
};

TEST(SoilRun, AFailureKeepsTheLastCheckpointOfBothSides) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(folder / "whole", plate_soil), 0);
  for (const bool throws : {false, true}) {
    const fs::path out = folder / (throws ? "throws" : "answers NaN");
    const auto failing = [&](const Scene& scene, const SoilStart&) {
      twins::HalfSpaceParameters p = plate(scene, 5.0);
      p.friction = 0.3;
      return std::make_unique<Failing>(p, throws);
    };
    testing::internal::CaptureStderr();
    EXPECT_EQ(run(out, failing), static_cast<int>(ExitStatus::soil_failed));
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find(throws ? "the soil fell over" : "is not a number"), std::string::npos) << said;
    EXPECT_NE(said.find("last good checkpoint of 0.2 h"), std::string::npos) << said;
    ASSERT_EQ(run(out, plate_soil, true), 0);
    expect_same_run(folder / "whole", out);
  }
}

TEST(SoilRun, ALostStateIsSaid) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(folder / "run", plate_soil, false, 0.2), 0);
  ASSERT_EQ(state_files(folder / "run").size(), 1u);
  fs::remove(folder / "run" / state_files(folder / "run")[0]);
  EXPECT_THROW(run(folder / "run", plate_soil, true), FileError);
}

}  // namespace
}  // namespace rootsoil::soil_test
