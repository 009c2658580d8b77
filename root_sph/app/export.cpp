// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "root_sph/app/commands.hpp"
#include "root_sph/core/errors.hpp"
#include "root_sph/io/frame_csv.hpp"
#include "root_sph/io/series.hpp"

namespace rootsoil {
namespace {

std::size_t nearest_frame(const std::vector<FrameInfo>& frames, const std::string& time) {
  if (time == "last") return frames.size() - 1;
  double wanted = 0.0;
  const auto [end, problem] = std::from_chars(time.data(), time.data() + time.size(), wanted);
  const double first = frames.front().time_h, last = frames.back().time_h;
  if (problem != std::errc() || end != time.data() + time.size() ||
      !(wanted >= first - 1e-9 && wanted <= last + 1e-9)) {
    throw InputError({"", 0, "--time", "there is no frame at this time", time,
                      fmt::format("{:g} to {:g} (h), or last", first, last), "choose a time that the run has written"});
  }
  std::size_t best = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    if (std::abs(frames[k].time_h - wanted) < std::abs(frames[best].time_h - wanted)) best = k;
  }
  return best;
}

}  // namespace

int export_run(const std::filesystem::path& run, const std::string& time, const std::filesystem::path& csv) {
  const std::filesystem::path series = std::filesystem::is_directory(run) ? run / "run.h5" : run;
  if (!std::filesystem::exists(series)) {
    throw InputError({run.string(), 0, "", "there is no run here: run.h5 is missing", "", "the folder of a run",
                      "give the folder that --out named"});
  }
  const std::vector<FrameInfo> frames = list_frames(series);
  if (frames.empty()) throw InputError({series.string(), 0, "", "the run has no frames yet", "", "", ""});
  const std::size_t index = nearest_frame(frames, time);
  write_frame_csv(csv, read_frame(series, index));
  fmt::print("{} cells at {:g} h -> {}\n", frames[index].cells, frames[index].time_h, csv.string());
  return static_cast<int>(ExitStatus::done);
}

}  // namespace rootsoil
