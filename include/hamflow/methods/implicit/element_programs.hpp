// The equations of a step of cg(1) as programs (numerics/program.hpp): what Newton asks of natural.hpp and general.hpp
// at one step, recorded with traces for a system of few coordinates. The functions of the problem at all Gauss points,
// their sums and the tangent are one straight line in machine code; what gradient and Hessian share is computed once.
//
// Numbers stand in a frame, from which every program reads and into which it writes:
//     h, q0, p0, x, correction | residual, lost, tangent | increments of q and p | three numbers | the element's point
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>

#include "hamflow/methods/implicit/general.hpp"
#include "hamflow/methods/implicit/natural.hpp"
#include "hamflow/numerics/program_of_tape.hpp"

namespace hamflow {

/// The rule of plain numbers, rounded to them.
template <>
inline const GaussRule<Trace<double>>& gauss_rule<Trace<double>>(int s) {
  static thread_local std::map<int, GaussRule<Trace<double>>> rules;
  return rules.try_emplace(s, detail::rounded<Trace<double>>(gauss_rule<double>(s))).first->second;
}
/// For products whose halves do not overflow, which every run of the recording checks.
inline Trace<double> product_error(const Trace<double>& a, const Trace<double>& b, const Trace<double>& product) {
  if (product.is_constant()) return product_error(a.value, b.value, product.value);
  static constexpr double splitter = (1 << 27) + 1;  // as in exact_product.hpp
  const auto high = [](const Trace<double>& x) {
    const Trace<double> large = splitter * x;
    return large - (large - x);
  };
  const Trace<double> a1 = high(a), b1 = high(b), a2 = a - a1, b2 = b - b1;
  const Trace<double> lost = ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2;
  lost.recorder->guard(lost.node, std::numeric_limits<double>::infinity(), false, Tape<double>::Relation::greater);
  return lost;
}

/// Where the numbers of a frame begin. @param n coordinates   @param m variables of Newton, n or 2 n
struct ElementFrame {
  static constexpr std::size_t most_coordinates = 3;
  static constexpr std::size_t most = 120;  // numbers
  std::size_t n = 0;
  std::size_t m = 0;
  static constexpr std::size_t h = 0;
  static constexpr std::size_t q0 = 1;
  std::size_t p0() const { return q0 + n; }
  std::size_t x() const { return q0 + 2 * n; }
  std::size_t correction() const { return x() + m; }
  std::size_t residual() const { return correction() + m; }
  std::size_t lost() const { return residual() + m; }
  std::size_t tangent() const { return lost() + m; }
  std::size_t increment() const { return tangent() + m * m; }
  std::size_t number() const { return increment() + 2 * n; }
  std::size_t point() const { return number() + 3; }
};

/// One of the programs, with the evaluations that it stands for. Recorded and compiled when it is first run.
class ElementProgram {
 public:
  using Record = std::function<Program(Effort&)>;
  explicit ElementProgram(Record record) : record_(std::move(record)) {}
  /// @return whether every number came out as the element computes it; if not, none did
  bool run(std::span<double> frame, Effort& effort) const {
    std::call_once(once_, [this] { loop_ = make_step_loop(record_(effort_)); });
    effort.force += effort_.force;
    effort.gradient += effort_.gradient;
    effort.hessian += effort_.hessian;
    return loop_->run(frame, 1);
  }

 private:
  Record record_;
  mutable std::once_flag once_;
  mutable Effort effort_;
  mutable std::unique_ptr<const StepLoop> loop_;
};

/// The programs of one quadrature.
struct ElementPrograms {
  ElementProgram predicted;  // x from (h, q0, p0)
  ElementProgram started;    // x from a memory, which stands in x
  ElementProgram evaluated;  // residual, lost, tangent, point and one number, the size of the flight, at x
  ElementProgram taken;      // x and increments at x
  ElementProgram corrected;  // the same at x + correction
  ElementProgram norm;       // a number, after `evaluated`
  ElementProgram work;       // of the increments: energy gained, size of its terms, rounding
};

namespace detail {

/// Records the programs of an element of traced numbers.
/// @tparam P a problem of dynamic size whose Real is Trace<double>   @tparam natural H = p^T M^-1 p/2 + V(q)
template <class P, bool natural>
class ElementRecorder {
  using Number = Trace<double>;
  using V = Vector<Number, dynamic>;
  using Plain = std::conditional_t<natural, NaturalElement<P, Number>, GeneralElement<P, Number>>;
  using Point = typename Plain::Point;
  using Frame = std::vector<Number>;

  /// With what the programs need of it.
  class Element : public Plain {
   public:
    using Plain::Plain;
    using Plain::taken;
    V lost(const V& x, const Point& at) const {
      if constexpr (natural) {
        return this->lost_in_residual(at, this->half_impulse(at));
      } else {
        Point sharp = at;
        this->sharpen(x, sharp);
        return sharp.residual;
      }
    }
    auto corrected(V& x, const Point& at, const V& correction) const {
      if constexpr (natural) {
        return this->taken(x, at, this->half_impulse(at), correction);
      } else {
        return this->taken(x, at, correction);
      }
    }
    Number flight() const {
      if constexpr (natural) {
        return this->flight_;
      } else {
        return Number(0);
      }
    }
  };

 public:
  ElementRecorder(const P& problem, const CgOptions& options, const ElementFrame& frame)
      : problem_(problem), setup_(problem, options), frame_(frame) {}

  static std::shared_ptr<const ElementPrograms> programs(const P& problem, const CgOptions& options,
                                                         const ElementFrame& frame) {
    const auto by = std::make_shared<const ElementRecorder>(problem, options, frame);
    const auto program = [by](auto&& body) {
      return ElementProgram::Record([by, body](Effort& effort) { return by->record(effort, body); });
    };
    return std::shared_ptr<const ElementPrograms>(new ElementPrograms{
        ElementProgram(program([by](const Element& e, Frame& f) { by->put(e.predicted(), f, by->frame_.x()); })),
        ElementProgram(program([by](const Element& e, Frame& f) { by->put(e.started(by->x(f)), f, by->frame_.x()); })),
        ElementProgram(program([by](const Element& e, Frame& f) { by->evaluate(e, f); })),
        ElementProgram(program([by](const Element& e, Frame& f) {
          V x = by->x(f);
          const Point at = by->point(f);
          by->put(e.taken(x, at), x, f);
        })),
        ElementProgram(program([by](const Element& e, Frame& f) {
          V x = by->x(f);
          const Point at = by->point(f);
          by->put(e.corrected(x, at, by->read(f, by->frame_.correction(), by->frame_.m)), x, f);
        })),
        ElementProgram(
            program([by](const Element& e, Frame& f) { f[by->frame_.number()] = e.norm(by->x(f), by->point(f)); })),
        ElementProgram(program([by](const Element& e, Frame& f) { by->work(e, f); }))});
  }

 private:
  Program record(Effort& effort, const auto& body) const {
    Recorder<double> recorder(Folding::exact);
    Frame frame;
    for (std::size_t i = 0; i < ElementFrame::most; ++i) frame.push_back(recorder.input(1));
    const V q0 = read(frame, frame_.q0, frame_.n);
    const V p0 = read(frame, frame_.p0(), frame_.n);
    body(Element(setup_, problem_, frame[frame_.h], q0, p0, effort), frame);
    return program_of(recorder.finish(frame));
  }

  void evaluate(const Element& e, Frame& f) const {
    Point at;
    const V d = x(f);
    e.evaluate(d, at);
    put(at.residual, f, frame_.residual());
    put(e.lost(d, at), f, frame_.lost());
    put(e.tangent(at), f, frame_.tangent());
    f[frame_.number()] = e.flight();
    std::size_t i = frame_.point();
    put(at.sum, f, i);
    put(at.target, f, i += frame_.m);
    if constexpr (natural) {
      put(at.stiffness, f, i += frame_.m);
    } else {
      put(at.noise, f, i += frame_.m);
    }
  }
  /// What evaluate() has left.
  Point point(const Frame& f) const {
    Point at;
    std::size_t i = frame_.point();
    at.residual = read(f, frame_.residual(), frame_.m);
    at.sum = read(f, i, frame_.m);
    at.target = read(f, i += frame_.m, frame_.m);
    if constexpr (natural) {
      at.stiffness = read_matrix(f, i += frame_.m);
    } else {
      at.noise = read(f, i += frame_.m, frame_.m);
      at.tangent = read_matrix(f, frame_.tangent());
    }
    return at;
  }
  void work(const Element& e, Frame& f) const {
    const std::size_t i = frame_.increment();
    const Increment<Number, dynamic> u{read(f, i, frame_.n), read(f, i + frame_.n, frame_.n)};
    const Number rounding = e.rounding_of_work(u);
    const auto seen = e.finer_work(u);
    f[frame_.number()] = seen.gain;
    f[frame_.number() + 1] = seen.size;
    f[frame_.number() + 2] = rounding;
  }

  V x(const Frame& f) const { return read(f, frame_.x(), frame_.m); }
  static V read(const Frame& f, std::size_t at, std::size_t count) {
    V out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = f[at + i];
    return out;
  }
  Matrix<Number, dynamic> read_matrix(const Frame& f, std::size_t at) const {
    Matrix<Number, dynamic> out(frame_.m);
    for (std::size_t i = 0; i < frame_.m * frame_.m; ++i) out[i / frame_.m][i % frame_.m] = f[at + i];
    return out;
  }
  static void put(const V& from, Frame& f, std::size_t at) {
    for (std::size_t i = 0; i < from.size(); ++i) f[at + i] = from[i];
  }
  static void put(const Matrix<Number, dynamic>& from, Frame& f, std::size_t at) {
    for (std::size_t i = 0; i < from.size() * from.size(); ++i) f[at + i] = from[i / from.size()][i % from.size()];
  }
  void put(const Increment<Number, dynamic>& taken, const V& x, Frame& f) const {
    put(x, f, frame_.x());
    put(taken.q, f, frame_.increment());
    put(taken.p, f, frame_.increment() + frame_.n);
  }

  P problem_;
  typename Plain::Setup setup_;
  ElementFrame frame_;
};

}  // namespace detail

}  // namespace hamflow
