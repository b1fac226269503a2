// How fcl_parity runs its questions:
// 1. A child process asks about each pair of types, each time with another seed.
// 2. It writes its findings into memory that it shares with the parent.
// 3. A question that ends the process or takes a second is noted, and a new child continues after it.
// 4. Findings become cells of Markdown tables.
#include "test/adapter/parity/questions.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>

namespace fcl_stpbv::parity {

using namespace test;

namespace {

/// Memory that a child and its parent share: the child's position, and its findings about each pair of types.
struct Shared {
  std::size_t pair = 0;
  int next = 0;  // number of the time that the pair is asked about next
  Findings findings[1];
};

void limitProcessorTime() {
  const itimerval limit{{0, 0}, {1, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);  // ends the process by SIGPROF
}

void askPair(const Type& a, const Type& b, const Question& question, int count, int seed, int& next,
             Findings& found) {
  while (next < count) {
    limitProcessorTime();
    const int i = next++;
    Random random(static_cast<std::uint64_t>(1 + i + 1000 * seed));
    try {
      question(a, b, i, random, found);
    } catch (const std::exception&) {
      found.theirs('x', true);
    }
  }
}

[[noreturn]] void askAll(const Pairs& pairs, const Question& question, int count, int seed, Shared& shared) {
  const rlimit noCore{0, 0};
  ::setrlimit(RLIMIT_CORE, &noCore);
  const int silence = ::open("/dev/null", O_WRONLY);  // hides FCL's warnings and assertions
  ::dup2(silence, STDOUT_FILENO);
  ::dup2(silence, STDERR_FILENO);
  std::cout.rdbuf(nullptr);  // they would be millions of lines, and half of the time
  std::cerr.rdbuf(nullptr);
  for (; shared.pair < pairs.size(); ++shared.pair, shared.next = 0)
    askPair(*pairs[shared.pair].first, *pairs[shared.pair].second, question, count, seed, shared.next,
            shared.findings[shared.pair]);
  ::_exit(0);
}

}  // namespace

void Findings::theirs(char letter, bool fault) { letter_[letter - 'a'] |= fault; }

void Findings::ours(const char* wrong, bool fault) {
  if (fault) std::snprintf(wrong_, sizeof wrong_, "%s", wrong);
}

void Findings::unanswered() { unanswered_ = true; }

void Findings::say(const char* answer) { std::snprintf(said_, sizeof said_, "%s", answer); }

std::string Findings::text() const {
  if (said_[0]) return said_;
  std::string letters;
  for (int i = 0; i < 26; ++i)
    if (letter_[i]) letters += static_cast<char>('a' + i);
  if (unanswered_) letters += '-';
  return letters.empty() ? "." : letters;
}

std::string Findings::ourFault() const { return wrong_; }

Placement placementOf(Random& random, int i) {
  const Eigen::Isometry3d a = pose(random.rotation(), random.direction());
  return {a, pose(random.rotation(), a.translation() + (i % 2 ? 0.2 : 0.7) * random.direction())};
}

std::vector<std::string> cellsOf(const Pairs& pairs, const Question& question, int count, int seed) {
  const std::size_t size = sizeof(Shared) + pairs.size() * sizeof(Findings);
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no memory shared with a child process");
  Shared& shared = *static_cast<Shared*>(memory);  // zeros, which new Findings consist of
  std::fflush(nullptr);
  while (shared.pair < pairs.size()) {
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot start a child process");
    if (child == 0) askAll(pairs, question, count, seed, shared);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) shared.findings[shared.pair].theirs('x', true);
  }
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string fault = shared.findings[i].ourFault();
    cells.push_back(fault.empty() ? shared.findings[i].text() : kOursIsWrong);
    if (!fault.empty())
      std::fprintf(stderr, "%s, %s: the library is wrong: %s\n", pairs[i].first->name.c_str(),
                   pairs[i].second->name.c_str(), fault.c_str());
  }
  ::munmap(memory, size);
  return cells;
}

std::string tableOf(const std::vector<Type>& types, const Question& question, int count, int seed) {
  Pairs pairs;
  for (const Type& a : types)
    for (const Type& b : types) pairs.push_back({&a, &b});
  const std::vector<std::string> cells = cellsOf(pairs, question, count, seed);
  std::string head = "|  |", rule = "|---|", rows;
  auto cell = cells.begin();
  for (const Type& a : types) {
    head += " " + a.name + " |";
    rule += "---|";
    rows += "| " + a.name + " |";
    for (std::size_t i = 0; i < types.size(); ++i) rows += " " + *cell++ + " |";
    rows += "\n";
  }
  return head + "\n" + rule + "\n" + rows;
}

}  // namespace fcl_stpbv::parity
