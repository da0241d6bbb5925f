// Where a flight first meets a wall, on the partial steps Psi_t of the method itself.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "hamflow/core/math.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

template <class R>
class WallSearch {
 public:
  explicit WallSearch(const std::vector<WallSide<R>>& sides) : sides_(sides) {}

  /// A wall, and the part of the flight behind which it is met.
  struct Hit {
    std::size_t side = 0;
    R part{};
  };
  /// stuck: the motion stays on a wall, however often it is thrown back; failed: as a look did.
  enum class Found { none, hit, stuck, failed };

  /// Of the flight of this length from q0 with the velocity v0 of H.
  /// @param look (part, q, v) points q and v to what is behind that part of the flight, until the next look; false
  /// where it cannot
  template <class Look>
  Found first(const R& length, const R* q0, const R* v0, const Look& look, Hit& hit) {
    length_ = length;
    start_.clear();
    for (const WallSide<R>& side : sides_) start_.push_back(point(side, R(0), q0, v0));
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      if (start_[k].beyond >= -rounding(k, q0) && start_[k].rate > R(0)) {
        hit = {k, R(0)};
        return Found::hit;
      }
    }
    const R* q = nullptr;
    const R* v = nullptr;
    if (!look(R(1), q, v)) return Found::failed;
    end_.clear();
    for (const WallSide<R>& side : sides_) end_.push_back(point(side, R(1), q, v));
    Found found = Found::none;
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      const R close = rounding(k, q0);
      const auto see = [&](const R& part, Point& to) {
        if (!look(part, q, v)) return false;
        to = point(sides_[k], part, q, v);
        return true;
      };
      const Point& start = start_[k];
      const Point& end = end_[k];
      const bool leaves = start.rate > R(0);
      const bool comes_in = end.rate < R(0);
      const bool ends_beyond = end.beyond > R(0);
      if (!ends_beyond) {
        if (!leaves || !comes_in) continue;
        const R ahead = start.beyond + R(2) * start.rate;
        const R behind = end.beyond - R(2) * end.rate;
        if (!(ahead > R(0) && behind > R(0))) continue;
      }
      Point from = start;
      Point to = end;
      if (ends_beyond) {
        if (start.beyond >= -close) {  // thrown back a moment ago, and here again
          if (comes_in) continue;      // rounding alone
          if (!turn(start, end, false, see, from)) return Found::failed;
          if (!(from.beyond < R(0))) return Found::stuck;
        }
      } else {
        if (!turn(start, end, true, see, to)) return Found::failed;
        if (!(to.beyond > R(0))) continue;
      }
      R part{};
      if (!locate(close, std::move(from), std::move(to), see, part)) return Found::failed;
      if (found == Found::none || part < hit.part) hit = {k, part};
      found = Found::hit;
    }
    return found;
  }

 private:
  /// A point of a flight, as one wall sees it.
  struct Point {
    R part{};
    R beyond{};
    R rate{};  // dbeyond/dpart, as H has it
  };
  Point point(const WallSide<R>& side, const R& part, const R* q, const R* v) const {
    const R rate = v[side.coordinate] * length_;
    return {part, side.beyond(q[side.coordinate]), side.side > 0 ? rate : R(-rate)};
  }
  /// What is on a wall as far as numbers can tell.
  R rounding(std::size_t k, const R* q0) const {
    const WallSide<R>& side = sides_[k];
    return 2 * std::numeric_limits<R>::epsilon() * larger(R(abs(side.at)), R(abs(q0[side.coordinate])));
  }

  /// Between a point inside and one beyond a wall: the last one inside, to rounding.
  template <class See>
  bool locate(const R& close, Point inside, Point outside, const See& see, R& part) const {
    constexpr int most = 4000;  // halvings of many digits
    const R epsilon = std::numeric_limits<R>::epsilon();
    R next = inside.rate > R(0) ? R(inside.part - inside.beyond / inside.rate) : R(0);
    Point point;
    for (int i = 0; i < most && outside.part - inside.part > 2 * epsilon * outside.part; ++i) {
      if (!(inside.part < next && next < outside.part)) {
        next = inside.part + (outside.part - inside.part) / R(2);
        if (!(inside.part < next && next < outside.part)) break;
      }
      if (!see(next, point)) return false;
      const R x = point.beyond;
      const R speed = point.rate;
      next = speed > R(0) ? R(point.part - (x > R(0) && x <= close ? 2 * close : x) / speed) : R(0);
      std::swap(x > R(0) ? outside : inside, point);
      if (x <= R(0) && x >= -close) break;
    }
    part = inside.part;
    return true;
  }

  /// Between points of rates of opposite signs: where it is furthest out, or nearest a point that is beyond (for
  /// outward = true), or inside.
  template <class See>
  bool turn(const Point& a, const Point& b, bool outward, const See& see, Point& found) const {
    Point left = a;
    Point right = b;
    const R enough = sqrt(std::numeric_limits<R>::epsilon()) / R(16);
    const bool rising = right.rate > R(0);
    found = outward == (left.beyond > right.beyond) ? left : right;
    for (int i = 0; i < 400 && right.part - left.part > enough * right.part; ++i) {
      const R rise = right.rate - left.rate;
      R next = left.part - left.rate * (right.part - left.part) / rise;
      const R width = right.part - left.part;
      // A secant that hardly moves an end is followed by a halving.
      if (i % 3 == 2 || !(left.part + width / R(1024) < next && next < right.part - width / R(1024))) {
        next = left.part + width / R(2);
      }
      Point point;
      if (!see(next, point)) return false;
      if (outward == (point.beyond > found.beyond)) found = point;
      if (outward ? found.beyond > R(0) : found.beyond < R(0)) return true;
      ((point.rate > R(0)) == rising ? right : left) = point;
    }
    return true;
  }

  const std::vector<WallSide<R>>& sides_;
  R length_{};
  std::vector<Point> start_;  // as each wall sees it
  std::vector<Point> end_;
};

}  // namespace hamflow
