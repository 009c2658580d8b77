// SPDX-License-Identifier: MIT
#include "root_sph/io/history.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string_view>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"

namespace rootsoil {
namespace fs = std::filesystem;
namespace {

constexpr const char* own_table =
    "the run goes on with its own table only: put it back, or move this file away; --resume then begins a new one";

// The header and the complete rows up to the time.
std::string rows_until(const fs::path& path, std::string_view header, double last_time_h) {
  const std::string text = read_whole_file(path);
  if (!text.starts_with(header)) {
    throw FileError(fmt::format("{}: its columns are not those of this run\n  given:   {}\n  allowed: {}",
                                path.string(), text.substr(0, text.find('\n')), header.substr(0, header.size() - 1)),
                    own_table);
  }
  std::size_t end = header.size();
  while (true) {
    const std::size_t line_end = text.find('\n', end);
    if (line_end == std::string::npos) break;
    double time_h = 0.0;
    const auto [stop, error] = std::from_chars(text.data() + end, text.data() + line_end, time_h);
    if (error != std::errc{}) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
      throw FileError(fmt::format("{}:{}: the row does not start with a time", path.string(), line), own_table);
    }
    if (time_h > last_time_h) break;
    end = line_end + 1;
  }
  return text.substr(0, end);
}

/// What is not known yet stays empty.
std::string cell_text(double value) { return std::isnan(value) ? std::string() : fmt::format("{}", value); }

}  // namespace

HistoryWriter::HistoryWriter(fs::path path, const std::vector<std::string>& columns,
                             std::optional<double> continue_from_h)
    : path_(std::move(path)), columns_(columns.size()) {
  const std::string header = fmt::format("{}\n", fmt::join(columns, ","));
  const bool goes_on = continue_from_h && fs::exists(path_);
  write_text_atomically(path_, goes_on ? rows_until(path_, header, *continue_from_h) : header);
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (file_ < 0) {
    const int error = errno;
    throw FileError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(error)), file_remedy(error));
  }
}

HistoryWriter::~HistoryWriter() {
  if (file_ >= 0) ::close(file_);
}

void HistoryWriter::append(std::span<const double> values) {
  ROOTSOIL_ASSERT(values.size() == columns_);
  std::vector<std::string> texts;
  std::transform(values.begin(), values.end(), std::back_inserter(texts), cell_text);
  const std::string row = fmt::format("{}\n", fmt::join(texts, ","));
  const off_t before = ::lseek(file_, 0, SEEK_END);
  const ssize_t written = ::write(file_, row.data(), row.size());
  if (written == static_cast<ssize_t>(row.size()) && ::fdatasync(file_) == 0) return;
  // a disk that fills up can take half a row; ENOSPC is reported by the next write only
  const int error = written >= 0 && written < static_cast<ssize_t>(row.size()) ? ENOSPC : errno;
  const bool whole_again = ::ftruncate(file_, before) == 0;
  throw FileError(fmt::format("{}: cannot be written: {}\n  kept:    {}", path_.string(), std::strerror(error),
                              whole_again ? "all rows before this one" : "all rows before this one, and a part of it"),
                  file_remedy(error));
}

}  // namespace rootsoil
