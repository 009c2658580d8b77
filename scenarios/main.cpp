// SPDX-License-Identifier: MIT
// The command line. What the commands do is in root_sph/app.
#include <omp.h>
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

#include "root_sph/app/commands.hpp"
#include "root_sph/app/shipped_scenes.hpp"
#include "root_sph/core/errors.hpp"
#include "root_sph/core/interruption.hpp"
#include "root_sph/core/version.hpp"
#include "root_sph/effects/soil_contact/soil_section.hpp"
#include "root_sph/effects/table.hpp"
#include "soil_coupling/penetrometer.hpp"
#include "soil_coupling/yade_soil.hpp"

namespace {

using namespace rootsoil;

/// The soil of a scene that has one: YADE, in a process of its own.
std::unique_ptr<SoilPort> yade_soil(const Scene& scene, const SoilStart& start) {
  return make_yade_soil(*scene.find<SoilSection>(), start);
}

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
constexpr int most_threads = 256;

const CLI::Validator thread_count(
    [](const std::string& text) {
      int number = 0;
      const bool good = CLI::detail::lexical_cast(text, number) && number >= 1 && number <= most_threads;
      return good ? std::string() : text + " is not a whole number from 1 to " + std::to_string(most_threads);
    },
    "NUMBER");

/// Where the command line says nothing OpenMP offers the machine's cores, or what the environment asks for. Before any
/// thread is started.
void limit_threads() {
  const char* given = std::getenv("OMP_NUM_THREADS");
  // more than fit into an int come out negative
  const int offered = std::min(omp_get_max_threads(), omp_get_thread_limit());
  const bool fits = offered >= 1 && offered <= most_threads;
  if (!given && !fits) return omp_set_num_threads(most_threads);  // a very large machine
  // a list is one number for each level of nested loops; OpenMP takes all cores where it can't read the first
  const std::string first = given ? std::string(given).substr(0, std::string(given).find(',')) : "1";
  int number = 0;
  if (fits && CLI::detail::lexical_cast(CLI::detail::trim_copy(first), number) && number >= 1) return;
  throw InputError({.file = {},
                    .line = 0,
                    .key = "OMP_NUM_THREADS",
                    .what = "the environment asks for a number of threads that no machine has or gains from",
                    .given = given && *given ? given : "nothing",
                    .allowed = "1 to " + std::to_string(most_threads),
                    .remedy = "unset it, or give run --threads"});
}

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
  const std::string version = std::string("rootsoil ") + program_version;
  CLI::App app{version + ": mechanical growth of plant roots, cell by cell", "rootsoil"};
  app.set_version_flag("--version", version, "Print the version");
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
  run->add_option("SCENE", scene_file, "Scene file (TOML), or the name of a shipped scene")->required();
  run->add_option("--out", options.out, "Folder of the run; otherwise runs/<scene name>");
  run->add_option("--threads", options.threads, "Number of threads; otherwise all")->check(thread_count);
  run->add_flag("--resume", options.resume, "Go on from the last checkpoint in the folder");
  run->add_option("--set", overrides, "section.key=value, replaces what the scene says; can be repeated")
      ->allow_extra_args(false);
  run->add_option("--accuracy", accuracy, "fast, balanced or reference");
  run->add_option("--until", options.until_h, "Stop at this simulated time, in hours")->check(positive);
  run->add_flag("--quiet", options.quiet, "Only warnings and errors");
  run->callback([&] {
    command = [&] {
      const Scene scene = read_scene(find_scene(scene_file), overrides, accuracy);
      if (options.out.empty()) options.out = std::filesystem::path("runs") / scene.scene.name;
      return run_scene(scene, options, yade_soil);
    };
  });

  bool json = false;
  CLI::App* check = app.add_subcommand("check", "Say what a scene would do and cost, without running it");
  check->add_option("SCENE", scene_file, "Scene file (TOML), or the name of a shipped scene")->required();
  check->add_option("--set", overrides, "section.key=value, replaces what the scene says; can be repeated")
      ->allow_extra_args(false);
  check->add_option("--accuracy", accuracy, "fast, balanced or reference");
  check->add_flag("--json", json, "For programs");
  check->callback(
      [&] { command = [&] { return check_scene(read_scene(find_scene(scene_file), overrides, accuracy), json); }; });

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
  penetrometer->add_flag("--quiet", options.quiet, "Only warnings and errors");
  penetrometer->callback([&] {
    command = [&] {
      const Scene scene = read_soil(find_scene(scene_file), overrides);
      if (options.out.empty()) options.out = std::filesystem::path("runs") / (scene.scene.name + "_penetrometer");
      return run_penetrometer(*scene.find<SoilSection>(), *scene.find<PenetrometerSection>(), options.out,
                              options.quiet);
    };
  });

  std::optional<std::string> section;
  CLI::App* describe_ = app.add_subcommand("describe", "Explain the keys of a scene file");
  describe_->add_option("SECTION", section, "One section, for example growth");
  describe_->callback([&] {
    command = [&] {
      std::cout << language().describe(section);
      return 0;
    };
  });

  app.add_subcommand("version", "Print the version")->callback([&] {
    command = [&version] {
      std::cout << version << '\n';
      return 0;
    };
  });

  if (argc > 1) check_command(app, argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : bad_usage;  // --help is one of them
  }
  if (options.threads == 0) limit_threads();
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
  end_at_once_when_interrupted();
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
