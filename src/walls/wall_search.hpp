// Finds where a path first hits a wall. The path is Psi_t, 0 <= t <= length: partial steps of the method.
//
// The two ends of a short path suffice: it ends beyond a wall, or it turns at most once and may have crossed the wall
// twice. A longer path may cross several times. It is divided into pieces such that a cubic Hermite interpolant through
// the ends of a piece agrees with a point between them; then a coordinate turns at most once in a piece.
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

  /// A wall, and the part of the path after which it is hit.
  struct Hit {
    std::size_t side = 0;
    R part{};
  };
  /// stuck: the motion stays on a wall although it is reflected; failed: an evaluation failed.
  enum class Found { none, hit, stuck, failed };

  /// The first wall on the path of this length from q0, with the velocity v0 of H.
  /// @param look (part, q, v): points q and v to the state after that part of the path, valid until the next call;
  /// returns false if it fails
  /// @param in_pieces searches in pieces even if the ends look like those of a short path
  template <class Look>
  Found first(const R& length, const R* q0, const R* v0, const Look& look, Hit& hit, bool in_pieces = false) {
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
      const Found met = meet(k, rounding(k, q0), start_[k], end_[k], look, found, hit);
      if (met == Found::stuck || met == Found::failed) return met;
      found = met;
      in_pieces = in_pieces || is_long(start_[k].beyond, start_[k].rate, end_[k].beyond, end_[k].rate);
    }
    return in_pieces ? first_in_pieces(q0, look, found, hit) : found;
  }

  /// Whether the two ends of a path show that it is not short. Rates are changes over the whole length. The ends of a
  /// parabola differ by the mean of the two rates; those of a quarter of an oscillation differ by 5/4 of it.
  static bool is_long(const R& from, const R& from_rate, const R& to, const R& to_rate) {
    const R apart = to - from - (from_rate + to_rate) / R(2);
    return R(8) * abs(apart) > larger(R(abs(from_rate)), R(abs(to_rate)));
  }

 private:
  /// A point of a path relative to one wall.
  struct Point {
    R part{};
    R beyond{};
    R rate{};  // dbeyond/dpart, from the velocity of H
  };
  Point point(const WallSide<R>& side, const R& part, const R* q, const R* v) const {
    const R rate = v[side.coordinate] * length_;
    return {part, side.beyond(q[side.coordinate]), side.side > 0 ? rate : R(-rate)};
  }
  /// The rounding within which a coordinate counts as on the wall.
  R rounding(std::size_t k, const R* q0) const {
    const WallSide<R>& side = sides_[k];
    return 2 * std::numeric_limits<R>::epsilon() * larger(R(abs(side.at)), R(abs(q0[side.coordinate])));
  }

  /// Finds the hit of a wall between two known points of the path, if it is before the hit found so far.
  template <class Look>
  Found meet(std::size_t k, const R& close, const Point& start, const Point& end, const Look& look, Found found,
             Hit& hit) const {
    const auto see = [&](const R& part, Point& to) {
      const R* q = nullptr;
      const R* v = nullptr;
      if (!look(part, q, v)) return false;
      to = point(sides_[k], part, q, v);
      return true;
    };
    const R length = end.part - start.part;
    const bool leaves = start.rate > R(0);
    const bool comes_in = end.rate < R(0);
    const bool ends_beyond = end.beyond > R(0);
    if (!ends_beyond) {
      if (!leaves || !comes_in) return found;
      const R ahead = start.beyond + R(2) * start.rate * length;
      const R behind = end.beyond - R(2) * end.rate * length;
      if (!(ahead > R(0) && behind > R(0))) return found;
    }
    Point from = start;
    Point to = end;
    if (ends_beyond) {
      if (start.beyond >= -close) {  // reflected a moment ago, and here again
        if (comes_in) return found;  // due to rounding
        if (!turn(start, end, false, see, from)) return Found::failed;
        if (!(from.beyond < R(0))) {
          hit.side = k;
          return Found::stuck;
        }
      }
    } else {
      if (!turn(start, end, true, see, to)) return Found::failed;
      if (!(to.beyond > R(0))) return found;
    }
    R part{};
    if (!locate(close, std::move(from), std::move(to), see, part)) return Found::failed;
    if (found == Found::none || part < hit.part) hit = {k, part};
    return Found::hit;
  }

  /// Searches in pieces before the hit that the two ends of the path gave; if there is no earlier one, that hit keeps
  /// all of its digits. If even the shortest pieces are not cubic (after a jump, or if the method no longer moves with
  /// the velocity of H), the rest is searched in pieces of the length of the longest good one.
  template <class Look>
  Found first_in_pieces(const R* q0, const Look& look, Found found, Hit& hit) {
    const R until = found == Found::hit ? hit.part : R(1);
    const R share = R(3) / R(8);  // not 1/2, which could be in resonance with the ends
    from_ = start_;
    constexpr int most_shorter = 1 << 14;
    R part(0);
    R length = until;
    R good = until / R(1024);
    bool is_smooth = true;
    while (part < until) {
      if (!is_smooth) length = good;
      bool is_last = !(part + length < until);
      if (is_last) length = until - part;
      R to = is_last ? until : R(part + length);
      if (!see_all(to, look, end_)) return Found::failed;
      while (true) {
        const R between = part + share * length;
        if (!see_all(between, look, inner_)) return Found::failed;
        if (!is_smooth || is_cubic(q0)) break;
        if (length < good / R(most_shorter)) {
          is_smooth = false;
          break;
        }
        std::swap(inner_, end_);
        length = share * length;
        to = between;
      }
      Found met = Found::none;
      for (const auto& [a, b] : {std::pair{&from_, &inner_}, std::pair{&inner_, &end_}}) {
        for (std::size_t k = 0; k < sides_.size(); ++k) {
          met = meet(k, rounding(k, q0), (*a)[k], (*b)[k], look, met, hit);
          if (met == Found::stuck || met == Found::failed) return met;
        }
        if (met == Found::hit) return met;
      }
      std::swap(from_, end_);
      part = to;
      if (is_smooth) good = larger(good, length);
      length *= R(2);
    }
    return found;
  }
  template <class Look>
  bool see_all(const R& part, const Look& look, std::vector<Point>& to) const {
    const R* q = nullptr;
    const R* v = nullptr;
    if (!look(part, q, v)) return false;
    to.clear();
    for (const WallSide<R>& side : sides_) to.push_back(point(side, part, q, v));
    return true;
  }
  /// Whether the inner points are on cubics through both ends, accurately enough to know where these turn.
  bool is_cubic(const R* q0) const {
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      const Point& a = from_[k];
      const Point& m = inner_[k];
      const Point& b = end_[k];
      const R h = b.part - a.part;
      const R s = (m.part - a.part) / h;
      const R rise = b.beyond - a.beyond;
      const R first = h * a.rate;
      const R last = h * b.rate;
      const R square = R(3) * rise - R(2) * first - last;
      const R cube = first + last - R(2) * rise;
      const R value = a.beyond + s * (first + s * (square + s * cube));
      const R slope = first + s * (R(2) * square + R(3) * s * cube);
      const R size = larger(larger(R(abs(rise)), R(abs(first))), larger(R(abs(last)), R(abs(h * m.rate))));
      const R enough = size / R(64) + R(8) * rounding(k, q0);
      if (!(abs(m.beyond - value) <= enough && abs(h * m.rate - slope) <= enough)) return false;
    }
    return true;
  }

  /// Finds the last point inside, to rounding, between a point inside and one beyond a wall.
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

  /// Between points with rates of opposite sign: finds the extreme point, or any point that is beyond (for outward =
  /// true) or inside.
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
      // A secant step that hardly moves an end is followed by a bisection.
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
  std::vector<Point> start_;  // relative to each wall
  std::vector<Point> end_;
  std::vector<Point> from_;  // the same for a piece
  std::vector<Point> inner_;
};

}  // namespace hamflow
