// 1. Some verdicts need no truth: process ended, refused, threw, not a number.
// 2. Otherwise an answer's error compared with the truth, in metres, minus what rounding explains.
// 3. Along a path, the gradient's change in a step compared with the largest change that the radii allow
// (docs/theory.md, 6).
// 4. The worst verdict counts.
#include "test/reference/stability/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fcl_stpbv::stability {

using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();
constexpr int kSampled = 3;  // truths along a path; the reference takes milliseconds for each

Vector3d vectorOf(const double (&v)[3]) { return Map<const Vector3d>(v, 3); }
double off(long double x, long double y) { return static_cast<double>(std::abs(x - y)); }

bool finite(const Answer& a) {
  return std::isfinite(a.distance) && vectorOf(a.normal).allFinite() &&
         (!a.hasPoints || (vectorOf(a.point[0]).allFinite() && vectorOf(a.point[1]).allFinite()));
}

/// Gives verdicts that need no truth. @returns false if the answer must be compared with the truth.
bool withoutTruth(const Situation& s, const Answer& a, Judgement& j) {
  using Kind = Answer::Kind;
  const auto is = [&](Verdict v) { return j.verdict = v, true; };
  switch (a.kind) {
    case Kind::exception:
      return is(Verdict::exception);
    case Kind::abort:
      return is(Verdict::abort);
    case Kind::hang:
      return is(Verdict::hang);
    case Kind::none:
      return true;  // the child ended before this answer
    case Kind::refusal:
      return is(s.expected == Expected::refusal ? Verdict::exact : Verdict::none);
    default:
      break;
  }
  if (s.expected == Expected::refusal) {
    // FCL reports an overlap also if it failed, but a distance is a claim.
    if (a.kind == Kind::overlap) return is(Verdict::exact);
    j.amount = std::abs(a.distance);
    return is(finite(a) ? Verdict::wrong : Verdict::nan);
  }
  return !finite(a) && is(Verdict::nan);
}

struct Rounding {
  double distance;  ///< rounding of an answer that is exact to rounding (m)
  double across;    ///< rounding of its points along the surface (m)
  double world;     ///< rounding of a coordinate in the world (m)
};

Rounding roundingOf(const Situation& s, const Placement& at) {
  const double size = sizeOf(s, at), big = std::max(s.a->radii.R, s.b->radii.R);
  const double world = at.a.translation().norm() + at.b.translation().norm() + size;
  return {64 * kUlp * size + s.slack, 64 * kUlp * (size + big) + s.slack, 8 * kUlp * world + s.slack};
}

/// The error of the distance that follows from the normal's error: a plane tilted by e has a gap smaller by d
/// e^2/2.
double normalError(const Vector3d& n, const Vector3L& right, long double length) {
  const double e = static_cast<double>((n.cast<long double>() - right).norm());
  return static_cast<double>(length) * e * e / 2;
}

double pointsError(const Answer& a, const Rounding& rounding) {
  if (!a.hasPoints) return 0;
  const Vector3d between = vectorOf(a.point[1]) - vectorOf(a.point[0]);
  const double error = (between - a.distance * vectorOf(a.normal)).norm();
  return error <= rounding.world + rounding.across ? 0 : error;
}

Judgement judged(double error, double rounding, double size) {
  Judgement j;
  j.amount = error;
  j.verdict = error <= rounding            ? Verdict::exact
              : error <= kTolerance * size ? Verdict::tolerance
                                           : Verdict::wrong;
  return j;
}

Judgement judgeSmooth(const Situation& s, const Placement& at, const SmoothTruth& truth, const Answer& a) {
  const Rounding rounding = roundingOf(s, at);
  const double size = sizeOf(s, at);
  double error = pointsError(a, rounding);
  if (truth.known) {
    const long double core = truth.distance + s.a->radii.r + s.b->radii.r;
    error = std::max(error, off(a.distance, truth.distance));
    error = std::max(error, a.lower - rounding.distance - static_cast<double>(truth.distance));
    error = std::max(error, static_cast<double>(truth.distance) - rounding.distance - a.upper);
    const double tilt = normalError(vectorOf(a.normal), truth.normal, core);
    const double grain = rounding.across * rounding.across / (2 * static_cast<double>(core));
    if (tilt > grain) error = std::max(error, tilt);
    return judged(error, rounding.distance, size);
  }
  // Deep overlap: any way out is accepted, if its length is right and both bounds hold.
  error = std::max(error, off(a.distance, smoothGap(s, at, vectorOf(a.normal))));
  error = std::max(error, static_cast<double>(truth.widest) - rounding.distance - a.upper);
  Judgement j = judged(error, rounding.distance, size);
  if (j.verdict != Verdict::exact) return j;
  const double missed = static_cast<double>(truth.widest) - a.distance;
  if (missed <= 1e-9 * size)  // tolerance of the reference's own steps
  {
    j.verdict = Verdict::global;
  } else {
    j.amount = missed;
    j.verdict = a.onlyLocal ? Verdict::local : Verdict::wrong;
  }
  return j;
}

Judgement judgeSharp(const Method& method, const Situation& s, const Placement& at, const SharpTruth& truth,
                     const Answer& a) {
  const Rounding rounding = roundingOf(s, at);
  const double size = sizeOf(s, at);
  const auto known = static_cast<double>(truth.distance);
  double error = 0;
  switch (a.kind) {
    case Answer::Kind::apart:
      error = truth.known ? std::max(0.0, -known) : truth.overlap ? size : 0;
      break;
    case Answer::Kind::overlap:
      error = truth.known ? std::max(0.0, known) : truth.overlap ? 0 : size;
      break;
    default:
      if (!truth.known) {
        error = truth.overlap ? std::max(0.0, a.distance) : 0;
      } else if (method.isSigned || known > 0) {
        error = std::abs(a.distance - known);
      } else {
        error = std::max(0.0, a.distance);
      }
      if (a.hasPoints && truth.known && known > 1e-3 * size && a.distance > 0) {
        error = std::max(error, pointsError(a, rounding));
        const double tilt = normalError(vectorOf(a.normal), truth.normal, truth.distance);
        // Rounding of points as far away as the bodies' size.
        if (tilt > 1e-15 * known) error = std::max(error, tilt);
      }
  }
  return judged(error, rounding.distance, size);
}

/// The gradient with respect to the second body's twist about its origin, in the first one's frame.
Eigen::Matrix<double, 6, 1> gradientOf(const Placement& at, const Answer& a) {
  const Matrix3d toA = at.a.linear().transpose();
  const Vector3d n = toA * vectorOf(a.normal);
  Eigen::Matrix<double, 6, 1> g;
  g << n, (toA * (vectorOf(a.point[1]) - at.b.translation())).cross(n);
  return g;
}

/// The largest change of the gradient between two placements that the radii allow, plus rounding.
double steepest(const Situation& s, const Placement& p, const Placement& q, double core) {
  const auto relative = [](const Placement& at) {
    return test::pose(at.a.linear().transpose() * at.b.linear(),
                      at.a.linear().transpose() * (at.b.translation() - at.a.translation()));
  };
  const Eigen::Isometry3d from = relative(p), to = relative(q);
  const double turn = (to.linear() - from.linear()).norm(),
               shift = (to.translation() - from.translation()).norm();
  const StpBv& v = s.b->smooth->volume();
  const double reach = v.centre().norm() + v.enclosingRadius(), big = s.b->radii.R;
  const Rounding rounding = roundingOf(s, p);
  const double normal = 2 * turn + (shift + turn * reach) / core + rounding.across / core;
  const double point = big * (normal + turn) + reach * turn + rounding.world + rounding.across;
  return normal * (1 + reach) + point + 1e-9;
}

/// The largest change that exceeds this, if any.
Judgement judgeSteps(const Situation& s, const std::vector<Answer>& answers) {
  Judgement worst;
  const auto usable = [](const Answer& a) {
    return a.kind == Answer::Kind::distance && a.hasPoints && a.distance > 0 && finite(a);
  };
  for (std::size_t i = 1; i < answers.size(); ++i) {
    const Answer &p = answers[i - 1], &q = answers[i];
    if (!usable(p) || !usable(q)) continue;
    const Placement &from = s.placements[i - 1], &to = s.placements[i];
    const double core = std::min(p.distance, q.distance) + s.a->radii.r + s.b->radii.r;
    if (core < 1e-6 * sizeOf(s, to)) continue;
    const double change = (gradientOf(to, q) - gradientOf(from, p)).norm();
    if (change <= 1.5 * steepest(s, from, to, core) || change <= worst.amount) continue;
    worst = {Verdict::jump, change, static_cast<int>(i)};
  }
  return worst;
}

bool worse(const Judgement& x, const Judgement& y) {
  return x.verdict != y.verdict ? x.verdict > y.verdict : x.amount > y.amount;
}

}  // namespace

const char* nameOf(Verdict verdict) {
  static const char* const names[kVerdicts] = {"exact",     "global", "local",     "within tolerance",
                                               "jump",      "wrong",  "no answer", "NaN",
                                               "exception", "hang",   "abort"};
  return names[static_cast<std::size_t>(verdict)];
}

std::string Judgement::text() const {
  switch (verdict) {
    case Verdict::wrong:
      return formatted("wrong by %.0e", amount);
    case Verdict::jump:
      return formatted("jump of %.0e", amount);
    default:
      return nameOf(verdict);
  }
}

Truths truthsOf(const Situation& s) {
  Truths truths;
  if (s.expected == Expected::refusal) return truths;
  const int count = static_cast<int>(s.placements.size());
  const int sampled = s.isPath ? std::min(count, kSampled) : count;
  for (int k = 0; k < sampled; ++k) {
    const int i = sampled == 1 ? 0 : k * (count - 1) / (sampled - 1);
    truths.placement.push_back(i);
    truths.smooth.push_back(smoothTruth(s, s.placements[static_cast<std::size_t>(i)]));
    truths.sharp.push_back(sharpTruth(s, s.placements[static_cast<std::size_t>(i)]));
  }
  return truths;
}

Judgement judge(const Method& method, const Situation& s, const Truths& truths,
                const std::vector<Answer>& answers) {
  Judgement worst = s.isPath ? judgeSteps(s, answers) : Judgement{};
  const auto consider = [&](Judgement j, int placement) {
    j.placement = placement;
    if (worse(j, worst)) worst = j;
  };
  for (std::size_t i = 0; i < answers.size(); ++i) {
    Judgement j;
    if (withoutTruth(s, answers[i], j)) consider(j, static_cast<int>(i));
  }
  for (std::size_t k = 0; k < truths.placement.size(); ++k) {
    const auto i = static_cast<std::size_t>(truths.placement[k]);
    Judgement j;
    if (withoutTruth(s, answers[i], j)) continue;
    j = method.smooth ? judgeSmooth(s, s.placements[i], truths.smooth[k], answers[i])
                      : judgeSharp(method, s, s.placements[i], truths.sharp[k], answers[i]);
    consider(j, static_cast<int>(i));
  }
  return worst;
}

}  // namespace fcl_stpbv::stability
