// An entry of the cache is used only if nobody else can have written it. The cache writes only into its own
// folder.
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/robot/volume_cache.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
namespace fs = std::filesystem;

namespace {

// Asks for the volume of a box of this size. @returns whether it came from the cache.
bool cached(const std::string& folder, double size) {
  VolumeCache cache(folder);
  const StpBv::Ptr volume = cache.volume(std::to_string(size), {0.01, 10}, [&] {
    return StpBv::build(box(size, size, size), {0.01, 10});
  });
  // The height of a big sphere's cap over a face: half the diagonal squared, divided by 2 R.
  CHECK(volume->support({1, 0, 0}) == Approx(size / 2 + 0.01).margin(1.1 * size * size / 2 / (2 * 10.0)));
  return cache.hits() > 0;
}

std::string onlyEntry(const std::string& folder) {
  std::string found;
  for (const auto& entry : fs::directory_iterator(folder)) found = entry.path().string();
  return found;
}

}  // namespace

TEST_CASE("an entry of another mesh, of another user or that others may write is built anew") {
  const TemporaryFolder folder;
  CHECK_FALSE(cached(folder / "a", 0.2));
  CHECK(cached(folder / "a", 0.2));
  CHECK_FALSE(cached(folder / "b", 0.4));
  const std::string entry = onlyEntry(folder / "a");
  const auto spoilt = [&](const auto& spoil) {
    spoil();
    CHECK_FALSE(cached(folder / "a", 0.2));  // and the entry is written again
    CHECK(cached(folder / "a", 0.2));
  };
  spoilt([&] { fs::copy_file(onlyEntry(folder / "b"), entry, fs::copy_options::overwrite_existing); });
  spoilt([&] { fs::permissions(entry, fs::perms::group_write, fs::perm_options::add); });
  spoilt([&] { fs::permissions(entry, fs::perms::others_write, fs::perm_options::add); });
  if (::geteuid() == 0)
    spoilt([&] { REQUIRE(::chown(entry.c_str(), 12345, 12345) == 0); });
  else
    WARN("another user's entry skipped: only root can make one");
}

TEST_CASE("a hull is rolled once, and again where its entry is damaged") {
  const TemporaryFolder folder;
  const std::vector<std::vector<Eigen::Vector3d>> clouds{box(0.1, 0.2, 0.3),
                                                         geodesicSphere(0.1, 2),
                                                         {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                                         {{0, 0, 0}, {1, 2, 3}}};
  const auto isRolled = [&](const std::vector<Eigen::Vector3d>& cloud) {
    const RolledHull hull = VolumeCache(folder / "a").convexHull(cloud), rolled = convexHull(cloud);
    return hull.vertices == rolled.vertices && hull.faces == rolled.faces;
  };
  for (const auto& cloud : clouds) CHECK(isRolled(cloud));
  for (const auto& entry : fs::directory_iterator(folder / "a")) {
    CAPTURE(entry.path().string());
    const std::string whole = contentOf(entry.path().string());
    for (const std::string& damaged :
         {whole + "3 0 1 2\n", whole.substr(0, whole.size() - 3), std::string()}) {
      put(entry.path().string(), damaged);
      for (const auto& cloud : clouds) CHECK(isRolled(cloud));
      CHECK(contentOf(entry.path().string()) == whole);
    }
  }
  for (const auto& cloud : clouds) CHECK(isRolled(cloud));  // from the cache
}

TEST_CASE("a link or a pipe in an entry's place is neither read nor written through") {
  const TemporaryFolder folder;
  CHECK_FALSE(cached(folder / "a", 0.2));
  const std::string entry = onlyEntry(folder / "a");
  put(folder / "precious", "mine");
  fs::remove(entry);
  fs::create_symlink(folder / "precious", entry);
  CHECK_FALSE(cached(folder / "a", 0.2));
  CHECK(contentOf(folder / "precious") == "mine");
  CHECK_FALSE(fs::is_symlink(entry));
  fs::remove(entry);
  REQUIRE(::mkfifo(entry.c_str(), 0600) == 0);
  CHECK_FALSE(cached(folder / "a", 0.2));
  CHECK(cached(folder / "a", 0.2));
}

TEST_CASE("files that a killed process left are removed an hour later, and no other files") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "a");
  for (const char* name : {"a/.fcl_stpbv-1-0.tmp", "a/.fcl_stpbv-2-0.tmp", "a/mine.tmp"})
    put(folder / name, "x");
  for (const char* name : {"a/.fcl_stpbv-3-0.tmp", "a/.fcl_stpbv-3-1.tmp.old"}) {  // of atomicWriteFolder()
    fs::create_directory(folder / name);
    put(folder / (std::string(name) + "/x"), "x");
  }
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(2);
  for (const char* name :
       {"a/.fcl_stpbv-1-0.tmp", "a/mine.tmp", "a/.fcl_stpbv-3-0.tmp", "a/.fcl_stpbv-3-1.tmp.old"})
    fs::last_write_time(folder / name, old);
  CHECK_FALSE(cached(folder / "a", 0.2));
  CHECK_FALSE(fs::exists(folder / "a/.fcl_stpbv-3-0.tmp"));
  CHECK(fs::exists(folder / "a/.fcl_stpbv-3-1.tmp.old/x"));  // somebody's data
  CHECK_FALSE(fs::exists(folder / "a/.fcl_stpbv-1-0.tmp"));
  CHECK(fs::exists(folder / "a/.fcl_stpbv-2-0.tmp"));
  CHECK(fs::exists(folder / "a/mine.tmp"));
}
