// Messages of the library in the words of Python, whose arguments and functions have other names.
#pragma once

#include <string>
#include <utility>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

/// What `work()` returns. @throws Error as it does, with those names. For what reads no file, whose name
/// might have such a word in it.
template <class Work>
auto inPythonsWords(const Work& work) {
  static const std::pair<const char*, const char*> kWords[] = {
      {"adviseRadii:", "advise_radii:"},
      {"barrierGain", "barrier_gain"},
      {"the constraints a larger influence, exactUpTo or hand-over",
       "the Robot a larger influence, exact_up_to or hand_over"},
      {"bothRound", "both_round"}};
  try {
    return work();
  } catch (const Error& error) {
    std::string message = error.what();
    for (const auto& [word, ours] : kWords)
      if (const std::size_t at = message.find(word); at != std::string::npos)
        message.replace(at, std::string(word).size(), ours);
    throw Error(message);
  }
}

}  // namespace fcl_stpbv
