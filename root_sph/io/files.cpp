// SPDX-License-Identifier: MIT
#include "root_sph/io/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/series.hpp"

namespace rootsoil {
namespace fs = std::filesystem;
namespace {

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

[[noreturn]] void fail(const fs::path& path, int error) {
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)), file_remedy(error));
}

bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

fs::path temporary_name(const fs::path& path) { return path.string() + ".tmp"; }

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

constexpr std::array traces_of_a_run = {"summary.json", "run.h5",     "checkpoint.h5",
                                        "history.csv",  "scene.toml", "frames"};

bool is_there(const fs::path& path) {
  std::error_code unreadable_counts_as_absent;
  return fs::exists(path, unreadable_counts_as_absent);
}

// "" when the folder holds none.
std::string describe_run(const fs::path& folder) {
  std::string traces;
  for (const char* name : traces_of_a_run) {
    if (is_there(folder / name)) traces += (traces.empty() ? "" : ", ") + std::string(name);
  }
  if (traces.empty()) return {};
  try {
    const SeriesMetadata metadata = read_metadata(folder / "run.h5");
    const std::vector<FrameInfo> frames = list_frames(folder / "run.h5");
    const auto scene = metadata.find("scene");
    return fmt::format("{}: scene '{}', {} frames up to {} h ({})", folder.string(),
                       scene == metadata.end() ? "?" : scene->second, frames.size(),
                       frames.empty() ? 0.0 : frames.back().time_h, traces);
  } catch (const FileError&) {  // the run stopped early, or its frames are damaged: its files still count
    return fmt::format("{}: {}", folder.string(), traces);
  }
}

}  // namespace

fs::path start_temporary(const fs::path& path, std::string_view content, std::uintmax_t room_bytes) {
  fs::path temporary = temporary_name(path);
  const Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
  if (file.get() < 0) fail(path, errno);
  bool written = write_all(file.get(), content);
  if (written && room_bytes > 0) {
    // some file systems can't set room aside; then there is nothing to do about it
    written = ::fallocate(file.get(), 0, 0, static_cast<off_t>(room_bytes)) == 0 || errno == EOPNOTSUPP;
  }
  if (!written) {
    const int error = errno;
    discard_temporary(path);  // gives the space back
    fail(path, error);
  }
  return temporary;
}

void commit_temporary(const fs::path& path) {
  const fs::path temporary = temporary_name(path);
  const Descriptor file(temporary, O_RDONLY);
  if (file.get() < 0 || ::fsync(file.get()) != 0 || ::rename(temporary.c_str(), path.c_str()) != 0) fail(path, errno);
  // the new name must survive a power cut as well; some file systems can't sync a folder and need not
  const Descriptor folder(folder_of(path), O_RDONLY | O_DIRECTORY);
  if (folder.get() < 0 || (::fsync(folder.get()) != 0 && errno != EINVAL)) fail(path, errno);
}

void discard_temporary(const fs::path& path) { ::unlink(temporary_name(path).c_str()); }

void write_text_atomically(const fs::path& path, std::string_view content) {
  start_temporary(path, content);
  commit_temporary(path);
}

std::string read_whole_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || fs::is_directory(path)) {
    const int error = file ? EISDIR : errno;
    throw FileError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(error)), file_remedy(error));
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

RunFolder::~RunFolder() {
  if (lock_ >= 0) ::close(lock_);
}

RunFolder claim_run_folder(const fs::path& path, bool resume) {
  if (resume && !is_there(path / "checkpoint.h5")) {
    throw InputError({.file = {},
                      .key = "--resume",
                      .what = "there is no checkpoint to go on from",
                      .given = path.string(),
                      .allowed = "the folder of a run that wrote checkpoint.h5",
                      .remedy = "name the run's folder with --out, or leave --resume out to start anew"});
  }
  std::error_code trouble;
  fs::create_directories(path, trouble);
  if (trouble) {
    throw FileError(fmt::format("{}: the run's folder cannot be created: {}", path.string(), trouble.message()),
                    file_remedy(trouble.value()));
  }
  Descriptor lock(path / ".lock", O_RDWR | O_CREAT);
  if (lock.get() < 0) {
    const int error = errno;
    throw FileError(fmt::format("{}: the run's folder cannot be written: {}", path.string(), std::strerror(error)),
                    file_remedy(error));
  }
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) fail(path / ".lock", errno);
    throw InputError({.file = {},
                      .key = "--out",
                      .what = "another process is writing a run to this folder",
                      .given = path.string(),
                      .allowed = "a folder that no run is using",
                      .remedy = "wait until it ends, or choose another folder with --out"});
  }
  if (const std::string run = describe_run(path); !resume && !run.empty()) {
    throw InputError({.file = {},
                      .key = "--out",
                      .what = "the folder already holds a run; nothing was overwritten",
                      .given = run,
                      .allowed = "a new or empty folder",
                      .remedy = "go on with that run by --resume, or choose another folder with --out"});
  }
  return {path, lock.release()};
}

}  // namespace rootsoil
