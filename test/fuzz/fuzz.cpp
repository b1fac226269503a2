// Random inputs for building, loading and queries, under the sanitizers. Failing inputs are reduced and kept.
//
//   fuzz [SECONDS] [SEED] [CASES]
//
// Replays the files in the folder CASES, then tries new inputs. A failure is written there, named by its
// target, and ends the run with status 1.
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "test/fuzz/target.h"
#include "test/reference/arguments.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::fuzz;

constexpr int kSeconds = 10;  // processor time for one input, with sanitizers
constexpr int kBatch = 200;   // inputs per child process

std::string folder;

/// Runs `work` in a child process. @returns true if it crashed, failed a property or did not end.
template <class Work>
bool fails(Work work, bool quiet) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    if (quiet && !(std::freopen("/dev/null", "w", stderr) && std::freopen("/dev/null", "w", stdout)))
      ::_exit(3);
    try {
      work();
    } catch (const std::exception& e) {
      std::fprintf(stderr, "fuzz: %s\n", e.what());
      ::_exit(2);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return child < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0;
}

void checkInTime(const Target& target, const std::string& text) {
  const itimerval limit{{0, 0}, {kSeconds, 0}};
  ::setitimer(ITIMER_PROF, &limit, nullptr);
  target.check(text, folder);
}

int report(const Target& target, const std::string& text, const std::string& cases) {
  const auto stillFails = [&](const std::string& t) { return fails([&] { checkInTime(target, t); }, true); };
  const std::string small = stillFails(text) ? shrunk(text, stillFails) : text;
  const std::string path =
      cases + "/" + target.name + "-" + std::to_string(std::hash<std::string>()(small) % 1000000) + ".txt";
  std::ofstream(path, std::ios::binary) << small;
  std::fprintf(stderr, "FAILED: %s, kept as %s\n", target.name, path.c_str());
  fails([&] { checkInTime(target, small); }, false);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "[SECONDS [SEED [FOLDER]]]", 3);
  const double seconds = arguments.number(1, 20.0, 1e-3);
  const std::uint64_t seed = arguments.number(2, std::uint64_t{1});
  const std::string cases = arguments.text(3, ".");
  std::string name = (std::filesystem::temp_directory_path() / "fcl_stpbv_fuzz_XXXXXX").string();
  if (!::mkdtemp(name.data())) return 1;
  folder = name;

  int failed = 0, replayed = 0;
  for (const Target& target : targets())
    for (const auto& entry : std::filesystem::directory_iterator(cases)) {
      const std::string file = entry.path().filename().string();
      if (file.rfind(std::string(target.name) + "-", 0) != 0) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      ++replayed;
      if (!fails([&] { checkInTime(target, text); }, false)) continue;
      std::fprintf(stderr, "FAILED: the kept case %s\n", file.c_str());
      ++failed;
    }

  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::uint64_t tried = 0;
  for (std::uint64_t batch = 0; !failed && std::chrono::steady_clock::now() < end; ++batch) {
    const Target& target = targets()[batch % targets().size()];
    const auto input = [&](std::uint64_t i) {
      test::Random random(seed * 1000003 + batch * kBatch + i);
      return target.generate(random);
    };
    const auto run = [&](std::uint64_t from, std::uint64_t to) {
      for (std::uint64_t i = from; i < to; ++i) {
        checkInTime(target, input(i));
        if (std::chrono::steady_clock::now() >= end) break;
      }
    };
    tried += kBatch;
    if (!fails([&] { run(0, kBatch); }, true)) continue;
    for (std::uint64_t i = 0; i < kBatch && !failed; ++i)
      if (fails([&] { run(i, i + 1); }, true)) failed = report(target, input(i), cases);
    if (!failed)
      std::fprintf(stderr, "%s: a batch failed, none of its inputs does alone\n", target.name), failed = 1;
  }
  std::filesystem::remove_all(folder);
  std::printf("%d kept cases replayed, about %llu inputs tried: %s\n", replayed,
              static_cast<unsigned long long>(tried), failed ? "FAILED" : "none fails");
  return failed ? 1 : 0;
}
