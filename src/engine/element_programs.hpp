// The equations of a step of cg(1) as programs (detail/numerics/program.hpp): the functions of natural.hpp and
// general.hpp that Newton needs, recorded with traces for a system of few coordinates. The functions of the problem at
// all Gauss points, their sums and the Jacobian are one straight-line program in machine code; common subexpressions of
// gradient and Hessian are computed once.
//
// The numbers are in a frame, which every program reads and writes:
//     h, q0, p0, x, correction | residual, lost, tangent | increments of q and p | three numbers | the element's point
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <span>

#include "hamflow/detail/methods/implicit/general.hpp"
#include "hamflow/detail/methods/implicit/natural.hpp"
#include "numerics/program_of_tape.hpp"

namespace hamflow {

/// The Gauss rule for traces, rounded like that for doubles.
template <>
inline const GaussRule<Trace<double>>& gauss_rule<Trace<double>>(int s) {
  static thread_local std::map<int, GaussRule<Trace<double>>> rules;
  return rules.try_emplace(s, detail::rounded<Trace<double>>(gauss_rule<double>(s))).first->second;
}
/// Valid unless the halves of a product overflow, which every run of the recording checks.
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

/// The places of the numbers in a frame. @param n coordinates   @param m variables of Newton's method, n or 2 n
struct ElementFrame {
  static constexpr std::size_t most_coordinates = 3;
  static constexpr std::size_t most = 120;  // maximum number of numbers
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

/// One of the programs, with its number of evaluations. It is recorded only after some calls. Before that it is
/// computed directly, with the same bits, because a short run, such as a member of a sweep, ends before recording pays
/// off.
class ElementProgram {
 public:
  using Compute = std::function<void(std::span<double>, Effort&)>;
  using Record = std::function<Program(Effort&)>;
  ElementProgram(Compute compute, Record record) : compute_(std::move(compute)), record_(std::move(record)) {}
  /// @return true if all numbers are valid, else none is
  bool run(std::span<double> frame, Effort& effort) const {
    const Made* const made = made_.load(std::memory_order_acquire);
    if (made == nullptr && runs_.fetch_add(1, std::memory_order_relaxed) < least_runs_to_record) {
      compute_(frame, effort);
      return true;
    }
    return run_loop(made != nullptr ? *made : make(), frame, effort);
  }

 private:
  static constexpr int least_runs_to_record = 500;
  struct Made {
    Effort effort;
    std::unique_ptr<const StepLoop> loop;
  };
  static bool run_loop(const Made& made, std::span<double> frame, Effort& effort) {
    effort.force += made.effort.force;
    effort.gradient += made.effort.gradient;
    effort.hessian += made.effort.hessian;
    return made.loop->run(frame, 1);
  }
  [[gnu::noinline]] const Made& make() const {
    std::call_once(once_, [this] {
      keep_.loop = make_step_loop(record_(keep_.effort));
      made_.store(&keep_, std::memory_order_release);
    });
    return keep_;
  }

  Compute compute_;
  Record record_;
  mutable std::atomic<int> runs_{0};
  mutable std::atomic<const Made*> made_{nullptr};
  mutable std::once_flag once_;
  mutable Made keep_;
};

/// The programs of one quadrature.
struct ElementPrograms {
  ElementProgram predicted;  // x from (h, q0, p0)
  ElementProgram started;    // x from a remembered solution in x
  ElementProgram evaluated;  // residual, lost, tangent, point, and the size of the free_displacement, at x
  ElementProgram taken;      // x and increments at x
  ElementProgram corrected;  // x and increments at x + correction
  ElementProgram norm;       // a number, after `evaluated`
  ElementProgram work;       // for the increments: energy gained, size of its terms, rounding
};

namespace detail {

/// The programs of an element as functions of a frame, with plain or traced numbers.
/// @tparam P a problem of dynamic size   @tparam natural H = p^T M^-1 p/2 + V(q)
template <class P, bool natural>
class ElementOnFrame {
  using Number = typename P::Real;
  using V = Vector<Number, dynamic>;
  using Plain = std::conditional_t<natural, NaturalElement<P, Number>, GeneralElement<P, Number>>;
  using Point = typename Plain::Point;
  using Frame = std::vector<Number>;

 public:
  /// Makes the functions that the programs need accessible.
  class Element : public Plain {
   public:
    using Plain::Plain;
    using Plain::taken;
    V lost(const V& x, const Point& at) const {
      if constexpr (natural) {
        return this->residual_rounding(at, this->half_impulse(at));
      } else {
        Point sharp = at;
        this->remove_residual_rounding(x, sharp);
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
    Number free_displacement() const {
      if constexpr (natural) {
        return this->flight_;
      } else {
        return Number(0);
      }
    }
  };

  ElementOnFrame(const P& problem, const CgOptions& options, const ElementFrame& frame)
      : problem_(problem), setup_(problem, options), frame_(frame) {}

  /// In the order of ElementPrograms.
  enum class Part { predicted, started, evaluated, taken, corrected, norm, work };
  void run(Part part, Frame& f, Effort& effort) const {
    const V q0 = read(f, frame_.q0, frame_.n);
    const V p0 = read(f, frame_.p0(), frame_.n);
    const Element e(setup_, problem_, f[frame_.h], q0, p0, effort);
    switch (part) {
      case Part::predicted:
        return put(e.predicted(), f, frame_.x());
      case Part::started:
        return put(e.started(x(f)), f, frame_.x());
      case Part::evaluated:
        return evaluate(e, f);
      case Part::taken: {
        V at_end = x(f);
        const Point at = point(f);
        return put(e.taken(at_end, at), at_end, f);
      }
      case Part::corrected: {
        V at_end = x(f);
        const Point at = point(f);
        return put(e.corrected(at_end, at, read(f, frame_.correction(), frame_.m)), at_end, f);
      }
      case Part::norm:
        f[frame_.number()] = e.norm(x(f), point(f));
        return;
      case Part::work:
        return work(e, f);
    }
  }

 private:
  void evaluate(const Element& e, Frame& f) const {
    Point at;
    const V d = x(f);
    e.evaluate(d, at);
    put(at.residual, f, frame_.residual());
    put(e.lost(d, at), f, frame_.lost());
    put(e.tangent(at), f, frame_.tangent());
    f[frame_.number()] = e.free_displacement();
    std::size_t i = frame_.point();
    put(at.sum, f, i);
    put(at.target, f, i += frame_.m);
    if constexpr (natural) {
      put(at.stiffness, f, i += frame_.m);
    } else {
      put(at.noise, f, i += frame_.m);
    }
  }
  /// The result of evaluate().
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

/// The programs of an element: on plain numbers, and recorded.
template <bool natural, class P, class Traced>
std::shared_ptr<const ElementPrograms> element_programs(const P& problem, const Traced& traced,
                                                        const CgOptions& options, const ElementFrame& frame) {
  using Part = typename ElementOnFrame<P, natural>::Part;
  using TracedPart = typename ElementOnFrame<Traced, natural>::Part;
  const auto plain = std::make_shared<const ElementOnFrame<P, natural>>(problem, options, frame);
  const auto program = [&](Part part) {
    return ElementProgram(
        [plain, part](std::span<double> numbers, Effort& effort) {
          std::vector<double> f(numbers.begin(), numbers.end());
          plain->run(part, f, effort);
          std::copy(f.begin(), f.end(), numbers.begin());
        },
        [traced, options, frame, part](Effort& effort) {
          Recorder<double> recorder(Folding::exact);
          std::vector<Trace<double>> f;
          for (std::size_t i = 0; i < ElementFrame::most; ++i) f.push_back(recorder.input(1));
          ElementOnFrame<Traced, natural>(traced, options, frame).run(static_cast<TracedPart>(part), f, effort);
          return program_of(recorder.finish(f));
        });
  };
  return std::shared_ptr<const ElementPrograms>(
      new ElementPrograms{program(Part::predicted), program(Part::started), program(Part::evaluated),
                          program(Part::taken), program(Part::corrected), program(Part::norm), program(Part::work)});
}

}  // namespace detail

}  // namespace hamflow
