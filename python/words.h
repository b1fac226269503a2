// Translates messages of the library to the argument and function names of Python.
#pragma once

#include <string>
#include <utility>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

/// Returns the result of `work()`. @throws Error as `work()` does, with Python's names. Not for functions
/// that read files, since a file name might contain such a word.
template <class Work>
auto inPythonsWords(const Work& work) {
  static const std::pair<const char*, const char*> kWords[] = {
      {"adviseRadii:", "advise_radii:"},
      {"barrierGain", "barrier_gain"},
      {"the constraints a larger influence, exactUpTo or hand-over",
       "the Robot a larger influence, exact_up_to or hand_over"},
      {"bothRound", "both_round"},
      {"modelForScene: ", ""}};
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
