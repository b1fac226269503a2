// The seams around a patch's region of normals, packed to be tested four at a time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace fcl_stpbv {

/// One side of a patch's region of normals: `n` is inside iff `n.normal <= limit`; past it lies `neighbour`.
struct Seam {
  Eigen::Vector3d normal;
  double limit;
  int neighbour;
};

/// The seam that a normal passes furthest: `past` is the largest `n.normal - limit`, <= 0 inside all of them.
struct Crossing {
  double past;
  int neighbour;
};

/// Up to four seams of one patch; an unused one holds for any normal. A patch with more has another block,
/// which `next` names among the further ones.
struct SeamBlock {
  static constexpr std::size_t kSize = 4;
  using Doubles = double __attribute__((vector_size(32), aligned(32)));  // aligned for any compiler flags
  using Integers = std::int64_t __attribute__((vector_size(32)));

  Doubles x{}, y{}, z{}, limit{2, 2, 2, 2};
  std::array<std::int32_t, kSize> neighbour{-1, -1, -1, -1};
  std::int32_t next = -1;

  void set(std::size_t slot, const Seam& seam) {
    x[slot] = seam.normal.x();
    y[slot] = seam.normal.y();
    z[slot] = seam.normal.z();
    limit[slot] = seam.limit;
    neighbour[slot] = seam.neighbour;
  }
  Seam seam(std::size_t slot) const {
    return {Eigen::Vector3d(x[slot], y[slot], z[slot]), limit[slot], neighbour[slot]};
  }

  /// The patch's block after this one, null for none.
  const SeamBlock* after(const SeamBlock* further) const { return next < 0 ? nullptr : further + next; }

  /// The largest `n.normal - limit` of the four, its slot in place of the two least bits. `n` is anything
  /// with three numbers; for one of another length than 1 the value is that many times as large.
  template <typename Vector>
  double past(const Vector& n, double length = 1.0) const {
    return largest(along(n) - length * limit);
  }

  /// The inverse of how far off the seam is that the way from the unit normal `n` along the tangent `h` meets
  /// first, with its slot likewise; next to nothing or less where it meets none.
  template <typename Vector>
  double ahead(const Vector& n, const Vector& h) const {
    constexpr double kAtOnce = 1e-12;  // rad; `n` may be past the seam already
    const Doubles room = limit - along(n), least = Doubles{} + kAtOnce;
    return largest(along(h) / (room > least ? room : least));
  }

  /// The slot in what `past` or `ahead` gave.
  static std::size_t slotOf(double tagged) {
    std::uint64_t key;
    std::memcpy(&key, &tagged, sizeof key);
    return key & (kSize - 1);
  }

 private:
  template <typename Vector>
  Doubles along(const Vector& n) const {
    return n[0] * x + n[1] * y + n[2] * z;
  }

  /// No branches, all seams at once.
  static double largest(const Doubles& p) {
    constexpr Integers slots{0, 1, 2, 3};
    Integers key;
    std::memcpy(&key, &p, sizeof key);
    key = (key & ~std::int64_t{kSize - 1}) | slots;
    Doubles tagged;
    std::memcpy(&tagged, &key, sizeof key);
    const Doubles other = __builtin_shufflevector(tagged, tagged, 2, 3, 0, 1);
    const Doubles larger = tagged > other ? tagged : other;
    return larger[0] > larger[1] ? larger[0] : larger[1];
  }
};
static_assert(alignof(SeamBlock) == 32);

/// The seams of one patch, one by one.
class Seams {
 public:
  class Iterator {
   public:
    Iterator(const SeamBlock* block, const SeamBlock* further) : block_(block), further_(further) {}
    Seam operator*() const { return block_->seam(slot_); }
    Iterator& operator++() {
      if (++slot_ < SeamBlock::kSize && block_->neighbour[slot_] >= 0) return *this;
      block_ = block_->after(further_);
      slot_ = 0;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return block_ != other.block_ || slot_ != other.slot_; }

   private:
    const SeamBlock *block_, *further_;
    std::size_t slot_ = 0;
  };

  /// From the patch's first block and the further ones of all patches.
  Seams(const SeamBlock& first, const SeamBlock* further)
      : first_(first.neighbour[0] < 0 ? nullptr : &first), further_(further) {}
  Iterator begin() const { return {first_, further_}; }
  Iterator end() const { return {nullptr, further_}; }

 private:
  const SeamBlock *first_, *further_;
};

}  // namespace fcl_stpbv
