#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cguide/exact/core/error.h"
#include "cguide/numeric/io/guide_io.h"

namespace cguide::numeric::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void RefuseWriting(const fs::path& file, const std::string& why) {
  throw Error(Error::Code::kIo, file.string() + ": cannot be written: " + why +
                                    "; check the folder, its permissions and the space left");
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  /** Closes now; some file systems report a failed write only here. */
  bool Close() {
    const int number = number_;
    number_ = -1;
    return ::close(number) == 0;
  }

 private:
  int number_;
};

// Removes the temporary file unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const fs::path& path() const { return path_; }
  void Keep() { path_.clear(); }

 private:
  fs::path path_;
};

bool WriteAll(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

// Opens a new file beside `file`; names already taken (by a run that was killed) are passed over.
int OpenBeside(const fs::path& file, fs::path* temporary) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    *temporary = file.parent_path() / ("." + file.filename().string() + "." +
                                       std::to_string(::getpid()) + "." + std::to_string(attempt));
    const int number = ::open(temporary->c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (number >= 0 || errno != EEXIST) return number;
  }
  return -1;
}

// A pipe or device (/dev/stdout) cannot be renamed over; it is written in place.
void WriteInPlace(const fs::path& file, std::string_view bytes) {
  Descriptor descriptor(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (descriptor.number() < 0 || !WriteAll(descriptor.number(), bytes) || !descriptor.Close()) {
    RefuseWriting(file, std::strerror(errno));
  }
}

}  // namespace

void WriteFileAtomically(const fs::path& file, std::string_view bytes) {
  if (!file.has_filename()) RefuseWriting(file, "the path names no file");
  std::error_code code;
  // A symbolic link stays one: the file it points to is replaced.
  const fs::path target = fs::is_symlink(file, code) ? fs::weakly_canonical(file, code) : file;
  const fs::file_status status = fs::status(target, code);
  if (fs::is_directory(status)) RefuseWriting(file, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) return WriteInPlace(target, bytes);

  fs::path name;
  Descriptor descriptor(OpenBeside(target, &name));
  if (descriptor.number() < 0) RefuseWriting(file, std::strerror(errno));
  TemporaryFile temporary(name);
  if (!WriteAll(descriptor.number(), bytes) || ::fsync(descriptor.number()) != 0 ||
      !descriptor.Close()) {
    RefuseWriting(file, std::strerror(errno));
  }
  if (::rename(temporary.path().c_str(), target.c_str()) != 0) {
    RefuseWriting(file, std::strerror(errno));
  }
  temporary.Keep();
  // The rename itself survives a power cut only once the folder is on disk; failure to sync it does
  // not change what readers see, so it is not an error.
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number() >= 0) ::fsync(directory.number());
}

}  // namespace cguide::numeric::io
