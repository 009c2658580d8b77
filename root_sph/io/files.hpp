// SPDX-License-Identifier: MIT
// Files that are either wholly there or not at all, and the folder of a run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace rootsoil {

/// Replaces the file in one step: whenever the process or the machine stops, either the old content or the new
/// one is there, complete. FileError (with the system's reason) leaves the old file as it was.
void write_text_atomically(const std::filesystem::path& path, std::string_view content);

/// The above in steps, for a file that a library completes in between. The first writes `content` to
/// a temporary file and makes it room_bytes long, so that the disk does not run full under the library (HDF5
/// cuts off what it did not need).
std::filesystem::path start_temporary(const std::filesystem::path& path, std::string_view content,
                                      std::uintmax_t room_bytes = 0);
void commit_temporary(const std::filesystem::path& path);
void discard_temporary(const std::filesystem::path& path);

/// The whole file as bytes; FileError when it can't be read.
std::string read_whole_file(const std::filesystem::path& path);

/// A run's folder, locked against other processes for as long as this object lives. The operating system
/// releases the lock however the process ends.
class RunFolder {
 public:
  RunFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_;
};

/// Creates the folder where needed. InputError: it holds a run and resume is false; resume is true and there is
/// no checkpoint; another process is writing there. FileError: it can't be created or written.
[[nodiscard]] RunFolder claim_run_folder(const std::filesystem::path& path, bool resume);

}  // namespace rootsoil
