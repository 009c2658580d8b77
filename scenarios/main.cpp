// SPDX-License-Identifier: MIT
// The command line. What the commands do is in root_sph/scene.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/commands.hpp"
#include "root_sph/scene/read_scene.hpp"
#include "root_sph/scene/schema.hpp"
#include "root_sph/scene/soil_start.hpp"
#include "soil_coupling/penetrometer.hpp"
#include "soil_coupling/yade_soil.hpp"

namespace {

using namespace rootsoil;

namespace {

/// The soil of a scene that has one: YADE, in a process of its own.
Soil yade_soil(const Scene& scene, const SoilStart& start) {
  return {make_yade_soil(*scene.soil, start), soil_contact_parameters(scene)};
}

}  // namespace

constexpr int bad_usage = static_cast<int>(ExitStatus::bad_input);
constexpr int our_mistake = 1;

/// CLI11's own speaks of ranges up to 1.8e308, digit by digit.
const CLI::Validator positive(
    [](const std::string& text) {
      double number = 0.0;
      return CLI::detail::lexical_cast(text, number) && number > 0 ? std::string() : text + " is not a number above 0";
    },
    "NUMBER");

/// Many more than a machine has cores only cost memory: threads beyond some thousands end the program.
const CLI::Validator thread_count(
    [](const std::string& text) {
      constexpr int most = 256;
      int number = 0;
      const bool good = CLI::detail::lexical_cast(text, number) && number >= 1 && number <= most;
      return good ? std::string() : text + " is not a whole number from 1 to " + std::to_string(most);
    },
    "NUMBER");

/// CLI11 answers a misspelt command with "a subcommand is required".
void check_command(const CLI::App& app, const std::string& given) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  if (given.starts_with('-') || std::find(commands.begin(), commands.end(), given) != commands.end()) return;
  throw InputError({.file = {},
                    .line = 0,
                    .key = {},
                    .what = "there is no such command",
                    .given = given,
                    .allowed = {},
                    .remedy = "did you mean " + nearest(given, commands) + "? --help lists them"});
}

int command_line(int argc, char** argv) {
  CLI::App app{"rootsoil " ROOTSOIL_VERSION ": mechanical growth of plant roots, cell by cell", "rootsoil"};
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return std::string("rootsoil: ") + e.what() + "\n  to do:   --help, also after a command, lists what there is\n";
  });
  std::function<int()> command;

  std::filesystem::path scene_file;
  std::vector<std::string> overrides;
  std::optional<std::string> accuracy;
  RunOptions options;
  CLI::App* run = app.add_subcommand("run", "Run a scene");
  run->add_option("SCENE", scene_file, "Scene file (TOML)")->required();
  run->add_option("--out", options.out, "Folder of the run; otherwise runs/<scene name>");
  run->add_option("--threads", options.threads, "Number of threads; otherwise all")->check(thread_count);
  run->add_flag("--resume", options.resume, "Go on from the last checkpoint in the folder");
  run->add_option("--set", overrides, "section.key=value, replaces what the scene says; can be repeated")
      ->allow_extra_args(false);
  run->add_option("--accuracy", accuracy, "fast, balanced or reference");
  run->add_option("--until", options.until_h, "Stop at this simulated time, in hours")->check(positive);
  run->add_flag("--quiet", options.quiet, "No progress");
  run->callback([&] {
    command = [&] {
      const Scene scene = read_scene(scene_file, overrides, accuracy);
      if (options.out.empty()) options.out = std::filesystem::path("runs") / scene.scene.name;
      return scene.soil ? run_scene(scene, options, yade_soil) : run_scene(scene, options);
    };
  });

  bool json = false;
  CLI::App* check = app.add_subcommand("check", "Say what a scene would do and cost, without running it");
  check->add_option("SCENE", scene_file, "Scene file (TOML)")->required();
  check->add_option("--set", overrides, "section.key=value, replaces what the scene says; can be repeated")
      ->allow_extra_args(false);
  check->add_option("--accuracy", accuracy, "fast, balanced or reference");
  check->add_flag("--json", json, "For programs");
  check->callback([&] { command = [&] { return check_scene(read_scene(scene_file, overrides, accuracy), json); }; });

  std::filesystem::path run_folder, csv;
  std::string time = "last";
  CLI::App* export_ = app.add_subcommand("export", "Write the cells at one time as CSV, a row a cell");
  export_->add_option("RUN", run_folder, "Folder of a run")->required();
  export_->add_option("--time", time, "Hours, or last")->capture_default_str();
  export_->add_option("--csv", csv, "File to write")->required();
  export_->callback([&] { command = [&] { return export_run(run_folder, time, csv); }; });

  CLI::App* effects = app.add_subcommand("effects", "List every effect that a scene can call for");
  effects->add_flag("--json", json, "For programs");
  effects->callback([&] { command = [&] { return list_effects(json); }; });

  CLI::App* penetrometer = app.add_subcommand("penetrometer", "Push a probe into the soil of a scene; needs YADE");
  penetrometer->add_option("SOIL", scene_file, "Scene file (TOML) with [soil] and [penetrometer]")->required();
  penetrometer->add_option("--out", options.out, "Folder of the results; otherwise runs/<scene name>_penetrometer");
  penetrometer->add_option("--set", overrides, "section.key=value, replaces what the file says; can be repeated")
      ->allow_extra_args(false);
  penetrometer->add_flag("--quiet", options.quiet, "No progress");
  penetrometer->callback([&] {
    command = [&] {
      const Scene scene = read_soil(scene_file, overrides);
      if (options.out.empty()) options.out = std::filesystem::path("runs") / (scene.scene.name + "_penetrometer");
      return run_penetrometer(*scene.soil, *scene.penetrometer, options.out, options.quiet);
    };
  });

  std::optional<std::string> section;
  CLI::App* describe_ = app.add_subcommand("describe", "Explain the keys of a scene file");
  describe_->add_option("SECTION", section, "One section, for example growth");
  describe_->callback([&] {
    command = [&] {
      std::cout << describe(section);
      return 0;
    };
  });

  app.add_subcommand("version", "Print the version")->callback([&] {
    command = [] {
      std::cout << "rootsoil " ROOTSOIL_VERSION "\n";
      return 0;
    };
  });

  if (argc > 1) check_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : bad_usage;  // --help is one of them
  }
  return command();
}

/// Threads that wait for each other should give way soon: libgomp's default lets them spin for milliseconds, which on a
/// machine shared with others costs ten times the work (measured). It reads the setting when it is loaded, so
/// the program starts itself once more with it. Whoever sets one of the variables decides.
void wait_politely(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") || std::getenv("OMP_WAIT_POLICY")) return;
  setenv("GOMP_SPINCOUNT", "1000", 1);
  execv("/proc/self/exe", argv);  // on failure go on as we are
}

}  // namespace

int main(int argc, char** argv) {
  wait_politely(argv);
  const auto report = [](const std::string& text, int status) {
    std::cerr << "rootsoil: " << text << '\n';
    return status;
  };
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is then an error of the write, with a message
  try {
    return command_line(argc, argv);
  } catch (const Error& e) {
    return report(e.what(), static_cast<int>(e.status()));
  } catch (const std::filesystem::filesystem_error& e) {
    return report(e.what(), static_cast<int>(ExitStatus::file_trouble));
  } catch (const std::bad_alloc&) {
    return report("not enough memory; fewer cells need less", our_mistake);
  } catch (const std::exception& e) {
    const std::string what = e.what(), kind = "internal error: ";
    return report(what.starts_with(kind) ? what : kind + what, our_mistake);
  }
}
