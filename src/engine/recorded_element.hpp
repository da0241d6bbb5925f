// cg(1) for few coordinates whose equations are recorded (element_programs.hpp): one compiled Newton iteration for
// every problem behind virtual calls, with about the speed and the same bits as elements that are compiled for a
// problem.
#pragma once

#include <map>
#include <utility>

#include "element_programs.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"

namespace hamflow {

/// The options of a recorded element.
struct RecordedElementOptions {
  CgOptions cg;
  ElementFrame frame;
  std::function<std::shared_ptr<const ElementPrograms>(int points)> record;
};

/// @tparam P of dynamic size
template <class P>
class RecordedElement : public SegmentEquations<P, double> {
  using Base = SegmentEquations<P, double>;

 public:
  using typename Base::Real;
  using typename Base::V;
  static constexpr std::size_t n = dynamic;
  using Variables = SmallVector;
  using Memory = SmallVector;

  class Setup : public SegmentSetup<double> {
   public:
    Setup(const P&, const RecordedElementOptions& options)
        : SegmentSetup<double>(options.cg), frame(options.frame), made_(std::make_shared<Made>()) {
      made_->record = options.record;
      choose();
    }
    const ElementPrograms& programs() const { return *programs_; }
    bool refine() { return SegmentSetup<double>::refine() && choose(); }
    void restart() {
      SegmentSetup<double>::restart();
      choose();
    }
    void return_to(const GaussRule<double>* rule) {
      SegmentSetup<double>::return_to(rule);
      choose();
    }
    template <class Archive>
    void archive(Archive& ar) {
      SegmentSetup<double>::archive(ar);
      if constexpr (Archive::reading) choose();
    }
    ElementFrame frame;

   private:
    struct Made {  // shared by copies, which may run on different threads
      std::mutex mutex;
      std::function<std::shared_ptr<const ElementPrograms>(int points)> record;
      std::map<int, std::shared_ptr<const ElementPrograms>> by_points;
    };
    bool choose() {
      const std::scoped_lock lock(made_->mutex);
      std::shared_ptr<const ElementPrograms>& found = made_->by_points[rule().points];
      if (!found) found = made_->record(rule().points);
      programs_ = found.get();
      return true;
    }
    std::shared_ptr<Made> made_;
    const ElementPrograms* programs_ = nullptr;
  };
  struct Point {
    SmallVector residual;
    mutable std::array<double, ElementFrame::most> frame;  // also the memory of the programs
  };

  RecordedElement(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(problem, h, setup.rule()), setup_(setup), frame_(setup.frame), q0_(q0), p0_(p0), effort_(effort) {}

  SmallVector last_state() const { return {{}, frame_.m}; }
  SmallVector predicted() const {
    Point at;
    begin(at);
    run(setup_.programs().predicted, at);
    return read(at, frame_.x());
  }
  SmallVector started(const SmallVector& memory) const {
    if (memory.size() != frame_.m) return last_state();  // after restoring a state of another size
    Point at;
    begin(at);
    put(memory, at, frame_.x());
    run(setup_.programs().started, at);
    return read(at, frame_.x());
  }
  void evaluate(const SmallVector& x, Point& at) const {
    begin(at);
    put(x, at, frame_.x());
    run(setup_.programs().evaluated, at);
    at.residual = read(at, frame_.residual());
  }
  void remove_residual_rounding(const SmallVector&, Point& at) const {
    if (is_natural() && frame_.n <= 2) return;  // taken() corrects this, as in natural.hpp
    const SmallVector lost = read(at, frame_.lost());
    for (std::size_t i = 0; i < frame_.m; ++i) at.residual[i] = is_natural() ? at.residual[i] + lost[i] : lost[i];
  }
  SmallRows tangent(const Point& at) const {
    SmallRows k;
    k.count = frame_.m;
    const double* from = at.frame.data() + frame_.tangent();
    for (std::size_t i = 0; i < frame_.m; ++i) {
      for (std::size_t j = 0; j < frame_.m; ++j) k[i][j] = *from++;
    }
    return k;
  }
  Correction<Real> measure(const SmallVector& x, const Point& at, const SmallVector& correction) const {
    if (is_natural()) {
      return NaturalElement<P, Real>::measured(at.frame[frame_.number()], read(at, frame_.point() + frame_.m), x,
                                               correction);
    }
    return GeneralElement<P, Real>::measured(read(at, frame_.point() + 2 * frame_.m), x, correction);
  }
  Real hidden_terms(const SmallVector& x, const Point& at, const SmallVector& correction) const {
    const SmallVector target = read(at, frame_.point() + frame_.m);
    return is_natural() ? NaturalElement<P, Real>::hidden_terms_of(at.frame[frame_.number()], target, x, correction)
                        : GeneralElement<P, Real>::hidden_terms_of(target, x, correction);
  }
  Increment<Real, n> taken(SmallVector& x, const Point& at) const {
    put(x, at, frame_.x());
    run(setup_.programs().taken, at);
    return increment_of(x, at);
  }
  Increment<Real, n> taken(SmallVector& x, const Point& at, const SmallVector& correction) const {
    SmallVector c = correction;
    if (is_natural() && frame_.n <= 2) {
      const SmallVector more = NaturalElement<P, Real>::made_up_for(tangent(at), read(at, frame_.lost()));
      for (std::size_t i = 0; i < frame_.m; ++i) c[i] += more[i];
    }
    put(x, at, frame_.x());
    put(c, at, frame_.correction());
    run(setup_.programs().corrected, at);
    return increment_of(x, at);
  }
  SmallVector memory(const SmallVector&, const Increment<Real, n>& taken) const {
    SmallVector all{{}, frame_.m};
    for (std::size_t i = 0; i < frame_.n; ++i) {
      if (!is_natural()) all[i] = taken.q[i];
      all[frame_.m - frame_.n + i] = taken.p[i];
    }
    return all;
  }
  Real norm(const SmallVector& x, const Point& at) const {
    put(x, at, frame_.x());
    const double free_displacement = at.frame[frame_.number()];
    run(setup_.programs().norm, at);
    return std::exchange(at.frame[frame_.number()], free_displacement);
  }
  bool too_coarse(const SmallVector&, const Increment<Real, n>& u) const {
    const Work work = finer_work(u);
    return abs(work.gain) > work.rounding;
  }
  bool energy_error_acceptable(const SmallVector&, const Increment<Real, n>& u) const {
    if (setup_.rule().points == 1) return true;
    const Work work = finer_work(u);
    return 100 * abs(work.gain) <= work.size;
  }

 private:
  struct Work {
    double gain;
    double size;
    double rounding;
  };
  Work finer_work(const Increment<Real, n>& u) const {
    Point at;
    begin(at);
    for (std::size_t i = 0; i < frame_.n; ++i) {
      at.frame[frame_.increment() + i] = u.q[i];
      at.frame[frame_.increment() + frame_.n + i] = u.p[i];
    }
    run(setup_.programs().work, at);
    const double* const number = at.frame.data() + frame_.number();
    return {number[0], number[1], number[2]};
  }

  bool is_natural() const { return frame_.m == frame_.n; }
  void begin(Point& at) const {
    at.frame[ElementFrame::h] = this->h_;
    for (std::size_t i = 0; i < frame_.n; ++i) {
      at.frame[ElementFrame::q0 + i] = q0_[i];
      at.frame[frame_.p0() + i] = p0_[i];
    }
  }
  /// If products are too large for the recording, all results are NaN and Newton does not converge.
  void run(const ElementProgram& program, const Point& at) const {
    if (!program.run(at.frame, effort_)) at.frame.fill(std::numeric_limits<double>::quiet_NaN());
  }
  SmallVector read(const Point& at, std::size_t from) const {
    SmallVector x;
    x.count = frame_.m;
    for (std::size_t i = 0; i < frame_.m; ++i) x[i] = at.frame[from + i];
    return x;
  }
  static void put(const SmallVector& x, const Point& at, std::size_t to) {
    for (std::size_t i = 0; i < x.size(); ++i) at.frame[to + i] = x[i];
  }
  Increment<Real, n> increment_of(SmallVector& x, const Point& at) const {
    x = read(at, frame_.x());
    Increment<Real, n> u{V(frame_.n), V(frame_.n)};
    for (std::size_t i = 0; i < frame_.n; ++i) {
      u.q[i] = at.frame[frame_.increment() + i];
      u.p[i] = at.frame[frame_.increment() + frame_.n + i];
    }
    return u;
  }

  const Setup& setup_;
  const ElementFrame& frame_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
};

}  // namespace hamflow
