// SPDX-License-Identifier: MIT
#include "root_sph/io/checkpoint.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"
#include "tests/io/temporary_folder.hpp"

namespace rootsoil {
namespace {

using test::TemporaryFolder;

Checkpoint example() {
  Checkpoint checkpoint{1.0 / 3.0, 123456789012345, "a1b2", "0.1.0", 3, {}, {}};
  checkpoint.reals["cells/volume"] = {0.1, -0.0, std::numeric_limits<double>::denorm_min(), 1e308};
  checkpoint.reals["growth/nothing"] = {};
  checkpoint.reals["window/pairs"].assign(5000, 0.7);
  checkpoint.integers["cells/cell_id"] = {1, -1, std::numeric_limits<std::int64_t>::min()};
  checkpoint.integers["random"] = {std::numeric_limits<std::int64_t>::max()};
  return checkpoint;
}

TEST(Checkpoint, ComesBackBitForBit) {
  const TemporaryFolder folder;
  write_checkpoint(folder / "checkpoint.h5", example());
  const Checkpoint read = read_checkpoint(folder / "checkpoint.h5");
  EXPECT_EQ(read, example());
  EXPECT_TRUE(std::signbit(read.reals.at("cells/volume")[1]));
}

TEST(Checkpoint, KeepsEveryBitOfANan) {
  const TemporaryFolder folder;
  Checkpoint checkpoint;
  const std::uint64_t bits = 0x7ff80000deadbeef;
  double value;
  std::memcpy(&value, &bits, sizeof value);
  checkpoint.reals["x"] = {value};
  write_checkpoint(folder / "checkpoint.h5", checkpoint);
  const Checkpoint read = read_checkpoint(folder / "checkpoint.h5");
  EXPECT_EQ(std::memcmp(read.reals.at("x").data(), &bits, sizeof bits), 0);
}

TEST(Checkpoint, AnyChangedByteAndAnyCutIsNoticed) {
  const TemporaryFolder folder;
  const auto path = folder / "checkpoint.h5";
  write_checkpoint(path, example());
  const std::string good = read_whole_file(path);
  for (std::size_t i = 0; i < good.size(); i += 1 + i / 37) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    std::ofstream(path, std::ios::binary) << bad;
    test::expect_contains(test::message_of<FileError>([&] { read_checkpoint(path); }), path.string());
    std::ofstream(path, std::ios::binary) << good.substr(0, i);
    test::expect_contains(test::message_of<FileError>([&] { read_checkpoint(path); }), path.string());
  }
  write_text_atomically(path, good + "x");
  test::expect_contains(test::message_of<FileError>([&] { read_checkpoint(path); }), "is damaged");
}

TEST(Checkpoint, MissingAndForeignFilesAreRefused) {
  const TemporaryFolder folder;
  test::expect_contains(test::message_of<FileError>([&] { read_checkpoint(folder / "none.h5"); }),
                        "none.h5: cannot be read: No such file");
  write_text_atomically(folder / "foreign.h5", "\x89HDF\r\n\x1a\n and so on");
  test::expect_contains(test::message_of<FileError>([&] { read_checkpoint(folder / "foreign.h5"); }),
                        "not a checkpoint of this program");
}

TEST(Checkpoint, OnAFullDiskThePreviousOneStays) {
  const TemporaryFolder folder;
  write_checkpoint(folder / "checkpoint.h5", example());
  Checkpoint later = example();
  later.step = 1;
  {
    const test::FullDisk full(1000);
    test::expect_contains(test::message_of<FileError>([&] { write_checkpoint(folder / "checkpoint.h5", later); }),
                          "checkpoint.h5");
  }
  EXPECT_EQ(read_checkpoint(folder / "checkpoint.h5"), example());
  EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint.h5.tmp"));
}

template <int Dim>
void declare_more(ParticleStore<Dim>& store) {
  store.template declare<double>({"turgor", "MPa", "", Storage::state}, on_division::copy<Dim, double>);
  store.template declare<double>({"scratch", "1", "", Storage::scratch}, on_division::recomputed<Dim, double>);
}

template <int Dim>
void round_trip_of_cells() {
  ParticleStore<Dim> store;
  declare_more(store);
  store.resize(5);
  double value = 0.1;
  for (const auto& field : store.fields()) {
    for (double& real : field->reals()) real = value *= 1.1;
    for (std::int64_t& integer : field->integers()) integer = static_cast<std::int64_t>(1e6 * (value *= 1.1));
  }
  Checkpoint checkpoint;
  store_cells(store, checkpoint);
  EXPECT_FALSE(checkpoint.reals.contains("cells/scratch"));

  ParticleStore<Dim> restored;
  declare_more(restored);
  restored.resize(9);
  restore_cells(checkpoint, restored);
  ASSERT_EQ(restored.size(), 5u);
  for (const auto& field : store.fields()) {
    if (field->info().storage == Storage::scratch) continue;
    FieldBase<Dim>& other = *restored.find(field->info().name);
    EXPECT_TRUE(std::ranges::equal(field->reals(), other.reals())) << field->info().name;
    EXPECT_TRUE(std::ranges::equal(field->integers(), other.integers())) << field->info().name;
  }
}

TEST(CheckpointOfCells, RoundTrip2D) { round_trip_of_cells<2>(); }
TEST(CheckpointOfCells, RoundTrip3D) { round_trip_of_cells<3>(); }

TEST(CheckpointOfCells, AFieldThatOneSideLacksIsNamed) {
  ParticleStore<2> plain, richer;
  declare_more(richer);
  plain.resize(2);
  richer.resize(2);
  Checkpoint of_plain, of_richer;
  store_cells(plain, of_plain);
  store_cells(richer, of_richer);
  test::expect_contains(test::message_of<FileError>([&] { restore_cells(of_plain, richer); }),
                        "lacks the field 'turgor'");
  test::expect_contains(test::message_of<FileError>([&] { restore_cells(of_richer, plain); }), "has a field 'turgor'");
  of_plain.reals["cells/mass"].push_back(1.0);
  test::expect_contains(test::message_of<FileError>([&] { restore_cells(of_plain, plain); }),
                        "field 'mass' has 3 values, 2 are needed");
}

}  // namespace
}  // namespace rootsoil
