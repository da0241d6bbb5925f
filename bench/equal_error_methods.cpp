// The methods that are compared at equal error: hamflow by type and by name, and other libraries.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "equal_error.hpp"
#include "hamflow/methods/averages.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/suzuki4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/compositions/yoshida6.hpp"
#include "hamflow/methods/dop853.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/splittings/rkn8_s19.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "library.hpp"
#include "mclachlan.hpp"
#include "other_libraries.hpp"

namespace bench {

namespace {

constexpr double period = 2 * std::numbers::pi;  // a = k = mass = 1

Task task_of(std::int64_t steps) {
  Task task = unit_task(period / static_cast<double>(steps));
  task.h_text = hamflow::shortest(task.h);
  return task;
}

/// A racer on the ellipse. After one period the exact solution is at the start.
TimedMethod on_ellipse(const std::string& name, int order, const Runner& run) {
  return {name, order, [run](std::int64_t steps, std::int64_t laps) {
            const Task task = task_of(steps);
            const Run all = run(task, steps * laps);
            return TimedMethod::CourseTiming{all.nanoseconds,
                                             std::hypot(all.end.q[0] - task.start.q[0], all.end.q[1] - task.start.q[1]),
                                             all.forces};
          }};
}
template <class Recipe>
TimedMethod typed(const std::string& name, int order, const Recipe& recipe) {
  return on_ellipse(name, order, [=](const Task& task, std::int64_t steps) { return run_typed(task, recipe, steps); });
}

std::string by_fixed_point(int stages) { return "gauss(stages=" + std::to_string(stages) + ",iteration=fixed-point)"; }
std::string gauss_name(int stages) { return "gauss(" + std::to_string(stages) + ")"; }

/// Runs a method by name on a course: one simulation for the error at the end, and one for the time, without the steps
/// in which the step is recorded and compiled.
/// @param request everything except the method   @param error returns the error of the end state
TimedMethod::CourseTiming run_by_name(hamflow::Request request, const std::string& method, std::int64_t steps,
                                      std::int64_t laps,
                                      const std::function<double(const std::vector<double>& q)>& error) {
  constexpr std::int64_t until_compiled = 400;
  request.method = hamflow::parse_method(method);
  request.watch = false;
  const auto once = hamflow::make_simulation(request);
  TimedMethod::CourseTiming lap;
  if (once->advance(steps) != hamflow::Outcome::done) return {1, INFINITY, 0};
  hamflow::Frame frame;
  once->look(frame);
  lap.error = error(frame.q);
  lap.forces = static_cast<double>(frame.effort.force);
  const auto often = hamflow::make_simulation(request);
  if (often->advance(until_compiled) != hamflow::Outcome::done) return {1, INFINITY, 0};
  lap.nanoseconds = timed([&] { (void)often->advance(steps * laps); });
  return lap;
}

TimedMethod ellipse_by_name(const std::string& name, int order, const std::string& method) {
  return {name, order, [method](std::int64_t steps, std::int64_t laps) {
            const Task task = task_of(steps);
            hamflow::Request request = kepler_request(task, "exact", "double");
            for (const double x : task.start.q) request.start.q.push_back(hamflow::shortest(x));
            for (const double x : task.start.p) request.start.p.push_back(hamflow::shortest(x));
            request.dt = task.h_text;
            return run_by_name(request, method, steps, laps, [&](const std::vector<double>& q) {
              return std::hypot(q[0] - task.start.q[0], q[1] - task.start.q[1]);
            });
          }};
}

/// Sun and planets, with the reference solution at the end of the course.
class OuterPlanets {
 public:
  OuterPlanets() {
    const hamflow::ProblemInfo& info = hamflow::usual_problem("solar-system")->info;
    request_.problem = info.name;
    request_.start.q = info.default_q;
    request_.start.p = info.default_p;
    request_.start.barycentric = true;
    hamflow::Request exact = of_steps(600);
    exact.method = hamflow::parse_method(by_fixed_point(10));
    exact.arithmetic = "double-double";
    const auto simulation = hamflow::make_simulation(exact);
    hamflow::Frame frame;
    if (simulation->advance(600) != hamflow::Outcome::done) throw std::runtime_error("no reference for the planets");
    simulation->look(frame);
    end_ = frame.q;
  }
  TimedMethod::CourseTiming run(const std::string& method, const std::string& arithmetic, std::int64_t steps,
                                std::int64_t laps) const {
    hamflow::Request request = of_steps(steps);
    request.arithmetic = arithmetic;
    return run_by_name(request, method, steps, laps, [&](const std::vector<double>& q) {
      double error = 0;
      for (std::size_t i = 0; i < q.size(); ++i) error = std::max(error, std::abs(q[i] - end_[i]));
      return error;
    });
  }

 private:
  hamflow::Request of_steps(std::int64_t steps) const {
    hamflow::Request request = request_;
    request.dt = "60000/" + std::to_string(steps);
    return request;
  }

  hamflow::Request request_;
  std::vector<double> end_;
};

}  // namespace

Course ellipse() {
  using namespace hamflow;
  std::vector<TimedMethod> all{typed("stv4", 4, Composition<compositions::stv4>{}),
                               typed("suzuki4", 4, Composition<compositions::suzuki4>{}),
                               typed("yoshida6", 6, Composition<compositions::yoshida6>{}),
                               typed("kahan-li8", 8, Composition<compositions::kahan_li8>{}),
                               typed("sb3a_m4", 4, SplittingBy<sb3a_m4>{}),
                               typed("rk4", 4, RungeKuttaBy<tableaus::rk4>{}),
                               typed("verlet", 2, Composition<compositions::verlet>{}),
                               typed("rkn8-s19", 8, SplittingBy<splittings::rkn8_s19>{}),
                               typed("dop853", 8, Dop853{{.fixed = true}}),
                               typed("cg(1,5)", 2, Cg{{.quadrature = 5}}),
                               typed("cg(2,4)", 4, CgOfDegree{{.degree = 2, .quadrature = 4}}),
                               typed("cg(3,6)", 6, CgOfDegree{{.degree = 3, .quadrature = 6}})};
  for (const int stages : {4, 8}) {
    all.push_back(typed(gauss_name(stages), 2 * stages, Gauss{{.stages = stages}}));
    all.push_back(ellipse_by_name(gauss_name(stages) + ", fixed-point", 2 * stages, by_fixed_point(stages)));
  }
  for (const auto& peers : {odeint_peers(), gsl_peers()}) {
    // A method of order 1 would need 10^8 steps or more.
    for (const OtherLibraryMethod& peer : peers) {
      if (peer.order > 1) all.push_back(on_ellipse(peer.library + " " + peer.stepper, peer.order, peer.run));
    }
  }
  return {"One period of the ellipse e = 0.6", all};
}

Course outer_planets() {
  const auto planets = std::make_shared<const OuterPlanets>();
  std::vector<TimedMethod> all;
  const auto put = [&](const std::string& name, int order, const std::string& method,
                       const std::string& arithmetic = "double") {
    all.push_back({name, order, [=](std::int64_t steps, std::int64_t laps) {
                     return planets->run(method, arithmetic, steps, laps);
                   }});
  };
  for (const char* method : {"stv4", "suzuki4"}) put(method, 4, method);
  for (const char* method : {"yoshida6", "srkn14a"}) put(method, 6, method);
  for (const char* method : {"kahan-li8", "rkn8-s19"}) put(method, 8, method);
  // gauss always has compensated sums.
  for (const char* method : {"kahan-li8", "rkn8-s19"})
    put(std::string(method) + ", compensated", 8, method, "compensated");
  for (const int stages : {4, 8}) put(gauss_name(stages) + ", fixed-point", 2 * stages, by_fixed_point(stages));
  return {"Sun and outer planets over 60 000 days", all, 200, 1'000'000};
}

}  // namespace bench
