// A folder is written completely or not at all.
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/temporary_name.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("a folder is made with its files, and replaced by exactly others") {
  const TemporaryFolder around;
  const std::string folder = around / "out";
  atomicWriteFolder(folder, {{"a", "one"}, {"deep/er/b", "two"}});
  CHECK(contentOf(folder + "/a") == "one");
  CHECK(contentOf(folder + "/deep/er/b") == "two");
  ::chmod(folder.c_str(), 0750);
  atomicWriteFolder(folder + "/", {{"c", "three"}});
  CHECK(contentOf(folder + "/c") == "three");
  CHECK_FALSE(fs::exists(folder + "/a"));
  CHECK_FALSE(fs::exists(folder + "/deep"));
  struct stat status {};
  REQUIRE(::stat(folder.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0750);
  CHECK(around.files() == std::vector<std::string>{"out"});
}

TEST_CASE("a new folder has the permissions of any other, and a name that is taken stays as it is") {
  const TemporaryFolder around;
  const mode_t mask = ::umask(027);
  // The names that the next writes would take.
  const std::string next = temporaryBeside(around / "out");
  const std::size_t number = next.rfind('-') + 1;
  const int serial = std::stoi(next.substr(number));
  for (int i = 1; i <= 3; ++i)
    fs::create_directory(next.substr(0, number) + std::to_string(serial + i) + ".tmp");
  atomicWriteFolder(around / "out", {{"a", "one"}});
  struct stat status {};
  REQUIRE(::stat((around / "out").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0750);
  CHECK(around.files().size() == 4);
  ::umask(mask);
}

TEST_CASE("a link to a folder stays a link") {
  const TemporaryFolder around;
  fs::create_directory(around / "real");
  fs::create_directory_symlink(around / "real", around / "link");
  atomicWriteFolder(around / "link", {{"a", "one"}});
  CHECK(fs::is_symlink(around / "link"));
  CHECK(contentOf(around / "real/a") == "one");
}

TEST_CASE("a folder that cannot be written is left as it was, and nothing beside it") {
  const TemporaryFolder around;
  const std::string folder = around / "out";
  CHECK_THROWS_WITH(atomicWriteFolder(around / "none/out", {{"a", "one"}}), Contains("none/out"));
  atomicWriteFolder(folder, {{"a", "one"}});
  const pid_t child = ::fork();  // with a size limit that the second file exceeds
  if (child == 0) {
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      atomicWriteFolder(folder, {{"a", "two"}, {"b", std::string(100000, 'x')}});
    } catch (const Error&) {
      ::_exit(3);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 3);
  CHECK(contentOf(folder + "/a") == "one");
  CHECK_FALSE(fs::exists(folder + "/b"));
  CHECK(around.files() == std::vector<std::string>{"out"});
}

TEST_CASE("a file that cannot be written is named where it would be") {
  const TemporaryFolder around;
  const std::string file = "meshes/" + std::string(300, 'n');
  const std::string message = refusal(
      [&](const std::string& folder) {
        atomicWriteFolder(folder, {{file, "one"}});
      },
      around / "out");
  CHECK_THAT(message, Contains(around / "out/" + file + ": cannot be written: File name too long"));
  CHECK(around.files().empty());
}
