// 1. Makes a new folder beside the old one.
// 2. Writes all files into it, and then flushes them to the disk together.
// 3. Exchanges the names of the two folders, in one step if the file system can do that, and removes the old
//    folder.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/signals_held.h"
#include "fcl_stpbv/io/temporary_name.h"

namespace fcl_stpbv::detail {
namespace {

namespace fs = std::filesystem;

// Removes what it names at the end, if it is there.
struct Removed {
  fs::path path;
  ~Removed() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

// `shown` stands for the path in messages.
void writeFile(const fs::path& path, const std::string& content, const fs::path& shown) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) refuseWrite(shown.parent_path(), error.value());
  errno = 0;
  std::ofstream out(path, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) refuseWrite(shown, errno != 0 ? errno : EIO);
}

// One call flushes all files, instead of one call for each file.
void toDisk(const fs::path& folder, const std::string& shown) {
  const int open = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool done = open >= 0 && ::syncfs(open) == 0;
  const int error = errno;
  if (open >= 0) ::close(open);
  if (!done) refuseWrite(shown, error);
}

void takeName(const fs::path& made, const fs::path& name) {
  struct stat old {};
  if (::stat(name.c_str(), &old) != 0) {
    if (::rename(made.c_str(), name.c_str()) != 0) refuseWrite(name, errno);
    return;
  }
  if (::chmod(made.c_str(), old.st_mode & 07777) != 0) refuseWrite(name, errno);
  if (::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, name.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != EINVAL && errno != ENOSYS) refuseWrite(name, errno);
  const fs::path aside = made.string() + ".old";  // not the name of a temporary one, which may be removed
  if (::rename(name.c_str(), aside.c_str()) != 0) refuseWrite(name, errno);
  if (::rename(made.c_str(), name.c_str()) != 0) {
    const int error = errno;
    if (::rename(aside.c_str(), name.c_str()) == 0) refuseWrite(name, error);
    throw Error(name.string() + ": another program has taken the name; the old folder is now " +
                aside.string());
  }
  const Removed replaced{aside};
}

// The folder's path without a slash at the end; symbolic links are followed.
fs::path placeOf(const std::string& folder) {
  fs::path name = fs::path(folder).lexically_normal();
  if (name.filename().empty()) name = name.parent_path();
  std::error_code none;
  if (const fs::path real = fs::canonical(name, none); !none) name = real;
  return name;
}

// Makes an empty folder beside `name` and returns its path.
std::string madeBeside(const fs::path& name, const std::string& folder) {
  for (;;) {
    std::string made = temporaryBeside(name.string());
    if (::mkdir(made.c_str(), 0777) == 0) return made;
    if (errno != EEXIST) refuseWrite(folder, errno);
  }
}

}  // namespace

void requireFolderPlace(const std::string& folder) {
  const EndPutOff putOff;
  const Removed temporary{madeBeside(placeOf(folder), folder)};
}

void atomicWriteFolder(const std::string& folder, const FolderFiles& files) {
  const EndPutOff putOff;
  const fs::path name = placeOf(folder);
  const std::string made = madeBeside(name, folder);
  const Removed temporary{made};  // after a swap the old folder
  for (const auto& [file, content] : files)
    writeFile(fs::path(made) / file, content, fs::path(folder) / file);
  toDisk(made, folder);
  takeName(made, name);
}

}  // namespace fcl_stpbv::detail
