// A file is written completely or not at all.
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <thread>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/signals_held.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Names = std::vector<std::string>;

TEST_CASE("a file is made and replaced, and keeps its permissions") {
  const TemporaryFolder folder;
  atomicWrite(folder / "a", "one");
  CHECK(contentOf(folder / "a") == "one");
  ::chmod((folder / "a").c_str(), 0640);
  atomicWrite(folder / "a", "two");
  CHECK(contentOf(folder / "a") == "two");
  struct stat status {};
  REQUIRE(::stat((folder / "a").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
  CHECK(folder.files() == Names{"a"});
}

TEST_CASE("a symbolic link is followed and stays a link") {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("real", folder / "link");
  atomicWrite(folder / "link", "one");
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(contentOf(folder / "real") == "one");
}

TEST_CASE("a place that cannot be written is refused by name") {
  const TemporaryFolder folder;
  const auto write = [](const std::string& path) { atomicWrite(path, "text"); };
  CHECK(refusal(write, folder / "none/a").find(folder / "none/a: cannot be written") == 0);
  CHECK(refusal(write, folder / "").find("cannot be written") != std::string::npos);
  CHECK(folder.files().empty());
}

TEST_CASE("files that belong together are written all or none") {
  const TemporaryFolder folder;
  atomicWrite(folder / "a", "old");
  const auto write = [&](const std::string& last) {
    atomicWriteAll({{folder / "a", "new"}, {folder / "b", "new"}, {last, "new"}});
  };
  CHECK(refusal(write, folder / "none/c").find(folder / "none/c: cannot be written") == 0);
  CHECK(refusal(write, "/dev/full").find("/dev/full: cannot be written") == 0);
  CHECK(folder.files() == Names{"a"});
  CHECK(contentOf(folder / "a") == "old");
  write(folder / "c");
  CHECK(folder.files() == Names{"a", "b", "c"});
  CHECK(contentOf(folder / "a") == "new");
}

TEST_CASE("what stands in the way of a file is named before the work, and nothing is made") {
  const TemporaryFolder folder;
  put(folder / "file", "old");
  std::filesystem::create_directory(folder / "folder");
  std::filesystem::create_symlink("none/a", folder / "link");
  const auto check = [](const std::string& path) { requireWritable(path, "-o " + path); };
  for (const char* good : {"new", "file", "folder/new"}) CHECK(refusal(check, folder / good) == "");
  for (const char* good : {"/dev/null", "/dev/stdout", "new"}) CHECK(refusal(check, good) == "");
  const std::pair<std::string, std::string> bad[] = {
      {folder / "folder", "is a folder, expected a file"},
      {folder / "none/a", "the folder " + (folder / "none") + " does not exist; make it first"},
      {folder / "link", "leads to " + (folder / "none/a")},
      {folder / "file/a", folder / "file" + " is a file, expected a folder"},
      {folder / "file/a/b", folder / "file" + " is a file, expected a folder"},
      {folder / std::string(300, 'n'), "File name too long"}};
  for (const auto& [path, message] : bad) {
    CHECK_THAT(refusal(check, path), Catch::StartsWith("-o " + path + ": ") && Catch::Contains(message));
  }
  CHECK(folder.files() == Names{"file", "folder", "link"});
  CHECK(contentOf(folder / "file") == "old");
}

TEST_CASE("a device is written straight and stays what it is") {
  atomicWrite("/dev/null", "text");
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("a write that fails half way leaves the old file and nothing else") {
  const TemporaryFolder folder;
  atomicWrite(folder / "a", "old");
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      atomicWrite(folder / "a", std::string(100000, 'x'));
    } catch (const Error&) {
      ::_exit(7);
    }
    ::_exit(1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 7);
  CHECK(contentOf(folder / "a") == "old");
  CHECK(folder.files() == Names{"a"});
}

TEST_CASE("a run that is interrupted leaves a whole file and nothing else") {
  const TemporaryFolder folder;
  const std::string one(300000, '1'), two(300000, '2');
  atomicWrite(folder / "a", one);
  Random random(5);
  for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGINT, SIGTERM, SIGHUP}) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      std::signal(signal, SIG_DFL);
      for (;;) {
        atomicWrite(folder / "a", two);
        atomicWrite(folder / "a", one);
      }
    }
    ::usleep(static_cast<useconds_t>(20000 + random.below(20000)));
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    const std::string content = contentOf(folder / "a");
    CHECK((content == one || content == two));
    CHECK(folder.files() == Names{"a"});
  }
}

TEST_CASE("a signal that another thread takes waits for the write as well") {
  const TemporaryFolder folder;
  const std::string one(300000, '1'), two(300000, '2');
  Random random(6);
  for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGQUIT, SIGQUIT}) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      const rlimit noCore{0, 0};  // otherwise SIGQUIT would leave a core file
      ::setrlimit(RLIMIT_CORE, &noCore);
      std::signal(signal, SIG_DFL);
      const auto writes = [&](const char* name) {
        for (;;) {
          atomicWrite(folder / name, two);
          atomicWrite(folder / name, one);
        }
      };
      std::thread a(writes, "a"), b(writes, "b");
      for (;;) ::pause();  // receives the signals
    }
    ::usleep(static_cast<useconds_t>(20000 + random.below(20000)));
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    CHECK(WIFSIGNALED(status));
    CHECK(WTERMSIG(status) == signal);
    for (const std::string& name : folder.files()) {
      CHECK((name == "a" || name == "b"));
      const std::string content = contentOf(folder / name);
      CHECK((content == one || content == two));
    }
  }
}

TEST_CASE("a signal that the application handles or ignores is left to it") {
  static std::atomic<int> handled{0};
  const TemporaryFolder folder;
  const auto before = std::signal(
      SIGTERM, +[](int) { ++handled; });
  {
    const EndPutOff putOff;
    ::raise(SIGTERM);
    CHECK(handled == 1);
  }
  CHECK(handled == 1);
  std::signal(SIGTERM, SIG_IGN);
  {
    const EndPutOff putOff;
    ::raise(SIGTERM);
  }
  CHECK(std::signal(SIGTERM, before) == SIG_IGN);
}
