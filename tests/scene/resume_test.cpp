// SPDX-License-Identifier: MIT
// Which scenes go on with the same run.
#include "root_sph/app/resume.hpp"

#include "root_sph/core/version.hpp"
#include "root_sph/io/files.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/scene/scene_text.hpp"

namespace rootsoil::testing {
namespace {

Scene scene_with(const std::vector<std::string>& overrides) {
  return parse_scene(minimal + pressure + growth, "scene.toml", overrides);
}

std::vector<std::string> differences(const Scene& now, const Scene& was) {
  return rootsoil::differences(resolved_values(language(), now), resolved_values(language(), was));
}

TEST(Resume, NamesEveryKeyThatDiffers) {
  const Scene was = scene_with({});
  EXPECT_TRUE(differences(was, was).empty());
  const std::vector<std::string> found = differences(scene_with({"growth.c_g=-0.5", "tissue.nu_axial=0.1"}), was);
  ASSERT_EQ(found.size(), 3u);  // G_MPa follows from nu_axial
  EXPECT_EQ(found[0], "tissue.nu_axial = 0.1 (was 0.06)");
  EXPECT_EQ(found[1].find("tissue.G_MPa = "), 0u);
  EXPECT_EQ(found[2].find("growth.c_g = -0.5 (was "), 0u);
}

TEST(Resume, NamesWhatCameAndWent) {
  const Scene bare = parse_scene(minimal, "scene.toml");
  EXPECT_EQ(differences(scene_with({}), bare).front(), "pressure.differential_MPa = 1.0 (was absent)");
  EXPECT_EQ(differences(bare, scene_with({})).size(), differences(scene_with({}), bare).size());
}

TEST(Resume, DigestAndDifferencesAgree) {
  const Scene was = scene_with({});
  for (const char* harmless : {"scene.duration_h=2", "output.checkpoint_every_h=0.5", "output.picture=true"}) {
    const Scene now = scene_with({harmless});
    EXPECT_EQ(scene_digest(now), scene_digest(was)) << harmless;
    EXPECT_TRUE(differences(now, was).empty()) << harmless;
  }
  for (const char* other :
       {"scene.seed=7", "output.every_h=0.5", "output.fields=[\"volume\"]", "numerics.force_tolerance=1e-6",
        "root.cell_size_mm=0.011", "pressure.differential_MPa=0.9"}) {
    const Scene now = scene_with({other});
    EXPECT_NE(scene_digest(now), scene_digest(was)) << other;
    EXPECT_FALSE(differences(now, was).empty()) << other;
  }
}

TEST(Resume, ReadsTheValuesOfAResolvedSceneBack) {
  const std::string sections =
      "\n[[obstacle]]\nshape = \"disc\"\nposition_mm = [1, 0]\nradius_mm = 0.1\n"
      "\n[[obstacle]]\nname = \"wall\"\nshape = \"plane\"\nposition_mm = [2, 0]\nangle_deg = 90\n";
  const Scene scene = parse_scene(minimal + pressure + growth + sections, "scene.toml");
  EXPECT_EQ(values_of_resolved_toml(resolved_toml(language(), scene)), resolved_values(language(), scene));
}

TEST(Resume, GrainsAreComparedByWhatTheFileHolds) {
  const test::TemporaryFolder folder;
  const std::string grain = "x_mm,y_mm,z_mm,radius_mm\n1.0,0.5,0,0.05\n";
  const auto digest_with = [&](const std::string& name, const std::string& grains) {
    write_text_atomically(folder / name, grains);
    return scene_digest(parse_scene(minimal + pressure + growth + soil + "grains_file = \"" + name + "\"\n",
                                    (folder / "scene.toml").string()));
  };
  const std::string digest = digest_with("grains.csv", grain);
  EXPECT_EQ(digest_with("moved.csv", grain), digest);
  EXPECT_NE(digest_with("grains.csv", grain + "1.0,-0.5,0,0.05\n"), digest);
}

TEST(Resume, RefusesAnotherVersionBeforeItComparesScenes) {
  Checkpoint checkpoint;
  checkpoint.program_version = "0.0.0";
  checkpoint.scene_digest = "of that version";
  try {
    refuse_foreign_checkpoint(scene_with({}), checkpoint, "nowhere");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem().given, "0.0.0");
    EXPECT_EQ(error.problem().allowed, program_version);
  }
}

}  // namespace
}  // namespace rootsoil::testing
