// 1. A child process answers one placement after another and sends each answer through a pipe. Each answer
// has a limit on processor time.
// 2. If answers end early, the way in which the child ended shows whether it was an abort or a hang.
// 3. A new child continues with the next situation.
#include "test/reference/stability/isolated.h"

#include <fcntl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>

namespace fcl_stpbv::stability {

namespace {

void limitProcessorTime(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  const itimerval limit{{0, 0},
                        {whole, static_cast<suseconds_t>((seconds - static_cast<double>(whole)) * 1e6)}};
  setitimer(ITIMER_PROF, &limit, nullptr);  // ends the process by SIGPROF
}

bool sendAll(int pipe, const Answer& answer) {
  const char* bytes = reinterpret_cast<const char*>(&answer);
  for (std::size_t sent = 0; sent < sizeof answer;) {
    const ssize_t now = ::write(pipe, bytes + sent, sizeof answer - sent);
    if (now <= 0) return false;
    sent += static_cast<std::size_t>(now);
  }
  return true;
}

bool receive(int pipe, Answer& answer) {
  char* bytes = reinterpret_cast<char*>(&answer);
  for (std::size_t got = 0; got < sizeof answer;) {
    const ssize_t now = ::read(pipe, bytes + got, sizeof answer - got);
    if (now <= 0) return false;
    got += static_cast<std::size_t>(now);
  }
  return true;
}

[[noreturn]] void answerFrom(const Method& method, const std::vector<Situation>& situations,
                             std::size_t first, double seconds, int pipe) {
  const int silence = ::open("/dev/null", O_WRONLY);  // the output of assertions and methods does not count
  ::dup2(silence, STDOUT_FILENO);
  ::dup2(silence, STDERR_FILENO);
  for (std::size_t i = first; i < situations.size(); ++i) {
    limitProcessorTime(seconds);
    const std::unique_ptr<Contestant> contestant = method.make(situations[i]);
    for (const Placement& at : situations[i].placements) {
      limitProcessorTime(seconds);
      Answer answer;
      try {
        answer = contestant->query(at);
      } catch (const std::exception&) {
        answer = Answer{};
        answer.kind = Answer::Kind::exception;
      }
      if (!sendAll(pipe, answer)) ::_exit(1);
    }
  }
  ::_exit(0);
}

}  // namespace

std::vector<std::vector<Answer>> answersOf(const Method& method, const std::vector<Situation>& situations,
                                           double seconds) {
  std::vector<std::vector<Answer>> all(situations.size());
  for (std::size_t i = 0; i < situations.size(); ++i) all[i].resize(situations[i].placements.size());
  std::fflush(nullptr);  // so that a child does not print the parent's buffered output
  for (std::size_t next = 0; next < situations.size();) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("cannot start a child process");
    if (child == 0) {
      ::close(ends[0]);
      answerFrom(method, situations, next, seconds, ends[1]);
    }
    ::close(ends[1]);
    std::size_t query = 0;
    while (next < situations.size()) {
      if (query == all[next].size()) {
        query = 0;
        ++next;
      } else if (receive(ends[0], all[next][query])) {
        ++query;
      } else {
        break;
      }
    }
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (next == situations.size()) break;
    const bool timeUp = WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF;
    all[next][query] = Answer{};
    all[next][query].kind = timeUp ? Answer::Kind::hang : Answer::Kind::abort;
    ++next;
  }
  return all;
}

}  // namespace fcl_stpbv::stability
