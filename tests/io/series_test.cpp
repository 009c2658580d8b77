// SPDX-License-Identifier: MIT
#include "root_sph/io/series.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"
#include "tests/io/temporary_folder.hpp"

namespace rootsoil {
namespace {

using test::TemporaryFolder;

const SeriesMetadata metadata = {{"program", "rootsoil"}, {"scene", "a µ-root"}, {"dimension", "3"}};

// Values that no two frames share, with the awkward ones among them.
Frame frame_at(int index, std::size_t cells = 700) {
  std::mt19937_64 random(static_cast<std::uint64_t>(index) + 1);
  std::normal_distribution<double> normal;
  const auto reals = [&](std::size_t components) {
    std::vector<double> values(cells * components);
    for (double& value : values) value = normal(random);
    if (values.size() > 2) {
      values[0] = std::numeric_limits<double>::denorm_min();
      values[1] = -0.0;
      values[2] = std::numeric_limits<double>::infinity();
    }
    return values;
  };
  std::vector<std::int64_t> ids(cells);
  for (std::int64_t& id : ids) id = static_cast<std::int64_t>(random());
  return {0.1 * index,
          index,
          {{"position", "mm", "centre of the cell", 3, reals(3)},
           {"stress", "MPa", "stress", 6, reals(6)},
           {"density", "ug/mm^3", "density", 1, reals(1)},
           {"cell_id", "1", "unique number", 1, ids}}};
}

void expect_equal(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.time_h, b.time_h);
  EXPECT_EQ(a.step, b.step);
  ASSERT_EQ(a.columns.size(), b.columns.size());
  for (std::size_t i = 0; i < a.columns.size(); ++i) {
    EXPECT_EQ(a.columns[i].name, b.columns[i].name);
    EXPECT_EQ(a.columns[i].unit, b.columns[i].unit);
    EXPECT_EQ(a.columns[i].meaning, b.columns[i].meaning);
    EXPECT_EQ(a.columns[i].components, b.columns[i].components);
    EXPECT_EQ(a.columns[i].values, b.columns[i].values);
  }
}

void expect_frames(const std::filesystem::path& run_h5, int count) {
  const std::vector<FrameInfo> frames = list_frames(run_h5);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) expect_equal(read_frame(run_h5, static_cast<std::size_t>(i)), frame_at(i));
}

TEST(Series, EveryFrameComesBackBitForBitBeforeAndAfterFinish) {
  const TemporaryFolder folder;
  SeriesWriter writer(folder.path(), metadata);
  for (int i = 0; i < 5; ++i) {
    writer.write(frame_at(i));
    expect_frames(folder / "run.h5", i + 1);
  }
  writer.finish();
  expect_frames(folder / "run.h5", 5);
  EXPECT_EQ(read_metadata(folder / "run.h5"), metadata);
  EXPECT_FALSE(std::filesystem::exists(folder / "frames"));
}

TEST(Series, AFinishedFileNeedsNoOther) {
  const TemporaryFolder folder, elsewhere;
  SeriesWriter writer(folder.path(), metadata);
  for (int i = 0; i < 3; ++i) writer.write(frame_at(i));
  writer.finish();
  std::filesystem::rename(folder / "run.h5", elsewhere / "moved.h5");
  expect_frames(elsewhere / "moved.h5", 3);
}

TEST(Series, AFrameWithoutCellsAndAFileWithoutFramesAreFine) {
  const TemporaryFolder folder;
  SeriesWriter writer(folder.path(), metadata);
  EXPECT_TRUE(list_frames(folder / "run.h5").empty());
  writer.write(frame_at(0, 0));
  expect_equal(read_frame(folder / "run.h5", 0), frame_at(0, 0));
  writer.finish();
  expect_equal(read_frame(folder / "run.h5", 0), frame_at(0, 0));
}

TEST(Series, ListsWhatAFrameHolds) {
  const TemporaryFolder folder;
  SeriesWriter writer(folder.path(), metadata);
  writer.write(frame_at(7));
  const FrameInfo frame = list_frames(folder / "run.h5").at(0);
  EXPECT_EQ(frame, writer.frames().at(0));
  EXPECT_EQ(frame.time_h, 0.1 * 7);
  EXPECT_EQ(frame.step, 7);
  EXPECT_EQ(frame.cells, 700);
  ASSERT_EQ(frame.columns.size(), 4u);
  EXPECT_EQ(frame.columns[1].name, "stress");
  EXPECT_EQ(frame.columns[1].unit, "MPa");
  EXPECT_EQ(frame.columns[1].components, 6);
  EXPECT_FALSE(frame.columns[1].is_integer);
  EXPECT_TRUE(frame.columns[3].is_integer);
}

TEST(Series, ResumedIsByteForByteWhatAnUninterruptedRunLeaves) {
  const TemporaryFolder straight, resumed;
  {
    SeriesWriter writer(straight.path(), metadata);
    for (int i = 0; i < 8; ++i) writer.write(frame_at(i));
    writer.finish();
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // a time of day in the file would now differ
  {
    SeriesWriter writer(resumed.path(), metadata);
    for (int i = 0; i < 6; ++i) writer.write(frame_at(i));
  }
  {
    SeriesWriter writer(resumed.path(), metadata, frame_at(3).time_h);
    EXPECT_EQ(writer.frames().size(), 4u);
    expect_frames(resumed / "run.h5", 4);
    EXPECT_FALSE(std::filesystem::exists(resumed / "frames/frame_000004.h5"));
    for (int i = 4; i < 8; ++i) writer.write(frame_at(i));
    writer.finish();
  }
  EXPECT_EQ(read_whole_file(straight / "run.h5"), read_whole_file(resumed / "run.h5"));
  EXPECT_EQ(read_whole_file(straight / "run.xmf"), read_whole_file(resumed / "run.xmf"));
}

TEST(Series, AFinishedSeriesGoesOn) {
  const TemporaryFolder folder;
  SeriesWriter first(folder.path(), metadata);
  for (int i = 0; i < 5; ++i) first.write(frame_at(i));
  first.finish();
  SeriesWriter second(folder.path(), metadata, frame_at(2).time_h);
  expect_frames(folder / "run.h5", 3);
  second.write(frame_at(3));
  expect_frames(folder / "run.h5", 4);
  second.finish();
  expect_frames(folder / "run.h5", 4);
}

TEST(Series, XdmfNamesEveryValueWithItsPlace) {
  const TemporaryFolder folder;
  SeriesWriter writer(folder.path(), metadata);
  writer.write(frame_at(0));
  writer.write(frame_at(1));
  const std::string text = read_whole_file(folder / "run.xmf");
  test::expect_contains(text, "<Time Value=\"0.1\"/>");
  test::expect_contains(text, "Dimensions=\"700 3\">run.h5:/frames/000001/position</DataItem></Geometry>");
  test::expect_contains(text, "Dimensions=\"700\">run.h5:/point_index<");
  test::expect_contains(text, "NumberType=\"Int\" Precision=\"8\" Dimensions=\"700\">run.h5:/frames/000000/cell_id<");
}

TEST(Series, OnAFullDiskWhatWasWrittenStays) {
  const TemporaryFolder folder;
  SeriesWriter writer(folder.path(), metadata);
  for (int i = 0; i < 3; ++i) writer.write(frame_at(i));
  {
    const test::FullDisk full(20000);
    const std::string message = test::message_of<FileError>([&] { writer.write(frame_at(3)); });
    test::expect_contains(message, "frame_000003.h5");
    test::expect_contains(message, "3 frames up to 0.2 h");
    test::message_of<FileError>([&] { writer.finish(); });
    expect_frames(folder / "run.h5", 3);
    EXPECT_FALSE(std::filesystem::exists(folder / "run.h5.tmp"));
  }
  writer.write(frame_at(3));
  writer.finish();
  expect_frames(folder / "run.h5", 4);
}

TEST(Series, DamagedForeignAndMissingFilesAreRefusedByName) {
  const TemporaryFolder folder;
  test::expect_contains(test::message_of<FileError>([&] { list_frames(folder / "run.h5"); }), "there is no such file");
  write_text_atomically(folder / "run.h5", "time_h,cells\n0,12\n");
  test::expect_contains(test::message_of<FileError>([&] { list_frames(folder / "run.h5"); }), "run.h5");
  std::filesystem::remove(folder / "run.h5");
  SeriesWriter writer(folder.path(), metadata);
  writer.write(frame_at(0));
  test::expect_contains(test::message_of<FileError>([&] { read_frame(folder / "run.h5", 1); }), "'/frames/000001'");
  std::filesystem::remove(folder / "frames/frame_000000.h5");
  test::expect_contains(test::message_of<FileError>([&] { list_frames(folder / "run.h5"); }), "'/frames/000000'");
}

// The child reports a frame after write() has returned; whenever it is killed, that many frames are readable.
TEST(Series, KilledAtAnyInstantEveryReportedFrameIsReadable) {
  std::mt19937 random(5);
  for (int attempt = 0; attempt < 25; ++attempt) {
    const TemporaryFolder folder;
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      SeriesWriter writer(folder.path(), metadata);
      for (int i = 0;; ++i) {
        writer.write(frame_at(i));
        const char report = 1;
        if (::write(pipe_ends[1], &report, 1) != 1) ::_exit(1);
        if (i % 7 != 6) continue;
        writer.finish();
        writer = SeriesWriter(folder.path(), metadata, frame_at(i).time_h);
      }
    }
    ::close(pipe_ends[1]);
    char report = 0;
    std::size_t reported = static_cast<std::size_t>(::read(pipe_ends[0], &report, 1));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 60000));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    while (::read(pipe_ends[0], &report, 1) == 1) ++reported;
    ::close(pipe_ends[0]);

    const std::size_t readable = list_frames(folder / "run.h5").size();
    EXPECT_GE(readable, reported);
    expect_frames(folder / "run.h5", static_cast<int>(readable));
    // and the series goes on
    SeriesWriter writer(folder.path(), metadata, frame_at(static_cast<int>(readable) - 1).time_h);
    writer.write(frame_at(static_cast<int>(readable)));
    writer.finish();
    expect_frames(folder / "run.h5", static_cast<int>(readable) + 1);
  }
}

}  // namespace
}  // namespace rootsoil
