// The class Simulation, which is advanced step by step.
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>

#include "bindings.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "signals.hpp"
#include "tables.hpp"

namespace py = pybind11;

namespace hamflow::python {

namespace {

/// Fills a table with the states at regular steps, or at given times.
class Sampler final : public Observer {
 public:
  /// @param digits whether to add columns digits/... with all digits as text
  Sampler(const Scenario& scenario, std::int64_t first, std::int64_t every, std::int64_t last, bool digits)
      : first_(first), every_(every), last_(last), digits_(digits) {
    const std::size_t longest = longest_digits(scenario.request.arithmetic);
    if (digits && longest == 0) {
      throw Error("digits: found True in " + scenario.request.arithmetic +
                  " arithmetic, whose numbers are doubles; allowed in arithmetic with more digits than double");
    }
    const std::size_t n = scenario.start_q.size();
    table_.add({.name = "q", .width = n, .scalar = false, .meaning = "coordinates"});
    table_.add({.name = "p", .width = n, .scalar = false, .meaning = "canonical momenta"});
    table_.add({.name = "energy", .meaning = "H(q, p)"});
    table_.add({.name = "step", .type = ValueType::integer, .meaning = "steps since the start"});
    table_.add({.name = "t", .meaning = "time"});
    for (const char* name : {"q", "p", "energy", "t"}) {
      if (!digits) break;
      ColumnInfo info = table_[name].info();
      info.name = std::string("digits/") + name;
      info.type = ValueType::text;
      info.text_size = longest;
      table_.add(std::move(info));
    }
    const std::int64_t samples = (last - first) / every + 1;
    try {
      for (Column& column : table_.columns()) column.reserve(static_cast<std::size_t>(samples) + 1);
    } catch (const std::exception&) {  // std::bad_alloc or std::length_error
      throw Error("steps, every: found " + std::to_string(samples) +
                  " samples, which do not fit into memory; allowed fewer steps, or a larger every");
    }
  }
  std::int64_t next_due(std::int64_t step) const override {
    if (step <= first_) return first_;
    const std::int64_t samples = (step - first_ - 1) / every_ + 1;  // rounds up without an overflow
    return samples <= (last_ - first_) / every_ ? first_ + samples * every_ : never;
  }
  Verdict observe(const Frame& frame) override {
    std::vector<Column>& columns = table_.columns();
    for (const double x : frame.q) columns[0].add(x);
    for (const double x : frame.p) columns[1].add(x);
    columns[2].add(frame.energy);
    columns[3].add(frame.step);
    columns[4].add(frame.time);
    if (digits_) {
      for (const std::string& x : frame.digits.q) columns[5].add(x);
      for (const std::string& x : frame.digits.p) columns[6].add(x);
      columns[7].add(frame.digits.energy);
      columns[8].add(frame.digits.time);
    }
    return Verdict::go_on;
  }
  Table take() { return std::move(table_); }

 private:
  Table table_;
  std::int64_t first_;
  std::int64_t every_;
  std::int64_t last_;
  bool digits_;
};

/// Calls a Python function after every `every` steps.
class Watcher final : public Observer {
 public:
  Watcher(std::int64_t every, py::object callback) : every_(every), callback_(std::move(callback)) {}
  std::int64_t next_due(std::int64_t step) const override {
    const std::int64_t calls = (std::max(step, seen_ + 1) - 1) / every_ + 1;  // rounds up without an overflow
    return calls <= never / every_ ? calls * every_ : never;
  }
  Verdict observe(const Frame& frame) override {
    seen_ = frame.step;
    const py::gil_scoped_acquire lock;
    const py::object answer = callback_();
    if (!py::isinstance<py::str>(answer)) return Verdict::go_on;
    const auto said = answer.cast<std::string>();
    if (said != "stop") throw Error("observe: the function returned \"" + said + "\"; allowed \"stop\", or nothing");
    return Verdict::stop;
  }
  void begin(std::int64_t step) { seen_ = step; }

 private:
  std::int64_t every_;
  std::int64_t seen_ = -1;
  py::object callback_;
};

[[noreturn]] void raise_failure(const Simulation& simulation, Outcome outcome) {
  Frame frame;
  simulation.look(frame);
  const std::string said = simulation.failure();
  const std::string why = said.empty() ? std::string(message(outcome)) : said.substr(0, said.find('\n'));
  const py::object type = py::module_::import("hamflow._errors").attr("StepFailed");
  const py::object error =
      type("step " + std::to_string(frame.step + 1) + ", from t = " + shortest(frame.time) + ": " + why,
           std::string(name(outcome)), frame.step, frame.time, std::string(hint(outcome)));
  PyErr_SetObject(type.ptr(), error.ptr());
  throw py::error_already_set();
}

/// A simulation that one thread at a time may use.
class PySimulation {
 public:
  explicit PySimulation(std::shared_ptr<Scenario> scenario)
      : scenario_(std::move(scenario)), simulation_(make_simulation(scenario_->request)) {}

  const Scenario& scenario() const { return *scenario_; }
  std::shared_ptr<Scenario> shared_scenario() const { return scenario_; }
  Simulation& simulation() const { return *simulation_; }

  /// While an InUse exists, a call from another thread throws an Error. An observing function runs on the thread that
  /// advances the simulation, and may read its state.
  class InUse {
   public:
    explicit InUse(const PySimulation& one, bool only_looks = true) : user_(one.user_) {
      std::thread::id nobody;
      const std::thread::id own = std::this_thread::get_id();
      is_first_ = user_.compare_exchange_strong(nobody, own);
      if (is_first_ || (only_looks && nobody == own)) return;
      throw Error(nobody == own
                      ? "the simulation is being advanced; an observing function may only read it and call copy()"
                      : "the simulation is used by another thread; use a copy() in each thread");
    }
    ~InUse() {
      if (is_first_) user_ = std::thread::id();
    }
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;

   private:
    std::atomic<std::thread::id>& user_;
    bool is_first_;
  };

  /// @return false if an observer stopped the simulation
  bool advance(std::int64_t steps, Observer* more) {
    require_steps(steps);
    if (steps < 100 && has_short_steps() && more == nullptr && watchers_.empty()) {  // too short to need Ctrl-C
      const InUse use(*this, false);
      const Outcome reached = simulation_->advance(steps);
      if (is_failure(reached)) raise_failure(*simulation_, reached);
      return true;
    }
    Interrupts interrupts;
    Outcome outcome = Outcome::done;
    const std::int64_t end = simulation_->step() + steps;
    {
      const InUse use(*this, false);
      std::vector<Observer*> observers;
      for (const auto& watcher : watchers_) {
        watcher->begin(simulation_->step());
        observers.push_back(watcher.get());
      }
      if (more != nullptr) observers.push_back(more);
      const py::gil_scoped_release unlocked;
      const std::function<bool()> goes_on = [&] { return interrupts.go_on(simulation_->step()); };
      const StopQuestion question(goes_on);
      outcome = run(*simulation_, end, observers, [&](std::int64_t step) { return interrupts.go_on(step); });
    }
    interrupts.rethrow();
    if (is_failure(outcome)) raise_failure(*simulation_, outcome);
    return simulation_->step() == end;
  }

  /// Measures the seconds of `calls` calls with `steps` steps each without Python, for bench/python_bench.py.
  double seconds_without_python(std::int64_t steps, std::int64_t calls) {
    require_steps(steps);
    const InUse use(*this, false);
    const py::gil_scoped_release unlocked;
    const auto begin = std::chrono::steady_clock::now();
    for (std::int64_t k = 0; k < calls; ++k) {
      if (const Outcome reached = simulation_->advance(steps); is_failure(reached))
        throw Error(std::string(message(reached)));
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  std::shared_ptr<Table> sample(std::int64_t steps, std::int64_t every, bool digits) {
    if (every < 1) throw Error("every: found " + std::to_string(every) + "; allowed 1 or more");
    require_steps(steps);
    const std::int64_t first = simulation_->step();
    Sampler sampler(*scenario_, first, every, first + steps, digits);
    (void)advance(steps, &sampler);
    return std::make_shared<Table>(sampler.take());
  }

  /// Samples the states at given times, by partial steps. The simulation ends at the last step before the last time, or
  /// where an observer stops it; then the table ends there, too.
  std::shared_ptr<Table> sample_at(const std::vector<std::string>& times, bool digits) {
    Sampler sampler(*scenario_, 0, 1, static_cast<std::int64_t>(times.size()), digits);
    const double dt = scenario_->dt;
    for (const std::string& text : times) {
      const double t = evaluate_number<double>(text);
      Frame frame = look();
      const double behind = (t - frame.time) / dt;
      if (!(behind >= -1e-9)) {
        throw Error("at: found t = " + text + ", which is before the present time " + shortest(frame.time) +
                    "; allowed times in the order of the motion");
      }
      const double whole = std::floor(behind * (1 + 4e-16) + 1e-12);
      if (whole >= 1 && !advance(static_cast<std::int64_t>(whole), nullptr)) break;
      const InUse use(*this);
      Frame there;
      const Outcome outcome = simulation_->look_ahead(text, there);
      if (is_failure(outcome)) raise_failure(*simulation_, outcome);
      there.step = simulation_->step();
      sampler.observe(there);
    }
    return std::make_shared<Table>(sampler.take());
  }

  Frame look() const {
    const InUse use(*this);
    Frame frame;
    simulation_->look(frame);
    return frame;
  }
  void negate_momenta() {
    const InUse use(*this, false);
    simulation_->negate_momenta();
  }
  std::unique_ptr<PySimulation> copy() const {
    const InUse use(*this);
    return std::unique_ptr<PySimulation>(new PySimulation(scenario_, simulation_->clone()));
  }
  py::bytes save() const {
    const InUse use(*this);
    std::vector<std::byte> bytes = simulation_->save();
    const std::uint64_t sum = fnv1a(bytes);
    const auto words = std::as_bytes(std::span(&sum, 1));
    bytes.insert(bytes.end(), words.begin(), words.end());
    return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void load(const py::bytes& saved) {
    const InUse use(*this, false);
    const std::string_view text = saved;
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    std::uint64_t sum = 0;
    if (bytes.size() < sizeof sum)
      throw Error("saved: found " + std::to_string(bytes.size()) + " bytes; allowed the bytes returned by save()");
    const auto content = bytes.first(bytes.size() - sizeof sum);
    std::memcpy(&sum, bytes.data() + content.size(), sizeof sum);
    if (sum != fnv1a(content)) throw Error("saved: the bytes are damaged; allowed the bytes returned by save()");
    simulation_->restore(content);
  }
  void watch(std::int64_t every, py::object callback) {
    if (every < 1) throw Error("every: found " + std::to_string(every) + "; allowed 1 or more");
    watchers_.push_back(std::make_shared<Watcher>(every, std::move(callback)));
  }

 private:
  static void require_steps(std::int64_t steps) {
    if (steps >= 0 && steps <= std::int64_t{1} << 53) return;
    throw Error("steps: found " + std::to_string(steps) +
                "; allowed from 0 to 2^53; to integrate backward, call reverse() first");
  }
  /// Whether 100 steps take only some milliseconds: a small problem in double arithmetic.
  bool has_short_steps() const {
    return scenario_->start_q.size() <= 32 && digits_beyond_double(scenario_->request.arithmetic) == 0;
  }
  PySimulation(std::shared_ptr<Scenario> scenario, std::unique_ptr<Simulation> simulation)
      : scenario_(std::move(scenario)), simulation_(std::move(simulation)) {}

  std::shared_ptr<Scenario> scenario_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<std::shared_ptr<Watcher>> watchers_;
  mutable std::atomic<std::thread::id> user_{};
};

py::dict digits_of(const Frame& frame) {
  py::dict all;
  all["t"] = frame.digits.time;
  all["q"] = frame.digits.q;
  all["p"] = frame.digits.p;
  all["energy"] = frame.digits.energy;
  return all;
}

py::dict counts_of(const Effort& effort) {
  py::dict all;
  all["force"] = effort.force;
  all["gradient"] = effort.gradient;
  all["hessian"] = effort.hessian;
  all["linear_solves"] = effort.linear_solves;
  return all;
}

}  // namespace

void bind_simulation(py::module_& m) {
  py::class_<PySimulation>(m, "Simulation")
      .def(py::init<std::shared_ptr<Scenario>>())
      .def_property_readonly("scenario", &PySimulation::shared_scenario)
      .def("advance", [](PySimulation& self, std::int64_t steps) { (void)self.advance(steps, nullptr); })
      .def("seconds_without_python", &PySimulation::seconds_without_python)
      .def("sample", &PySimulation::sample)
      .def("sample_at", &PySimulation::sample_at)
      .def("negate_momenta", &PySimulation::negate_momenta)
      .def("copy", &PySimulation::copy)
      .def("save", &PySimulation::save)
      .def("load", &PySimulation::load)
      .def("watch", &PySimulation::watch)
      .def_property_readonly("step", [](const PySimulation& self) { return self.look().step; })
      .def_property_readonly("t", [](const PySimulation& self) { return self.look().time; })
      .def_property_readonly("q", [](const PySimulation& self) { return array_of(self.look().q); })
      .def_property_readonly("p", [](const PySimulation& self) { return array_of(self.look().p); })
      .def_property_readonly("energy", [](const PySimulation& self) { return self.look().energy; })
      .def_property_readonly("digits", [](const PySimulation& self) { return digits_of(self.look()); })
      .def_property_readonly("evaluations", [](const PySimulation& self) { return counts_of(self.look().effort); })
      .def_property_readonly("energy_range",
                             [](const PySimulation& self) {
                               const PySimulation::InUse use(self);
                               const Excursion e = self.simulation().energy();
                               return py::make_tuple(e.initial, e.final, e.max_error, e.scale());
                             })
      .def_property_readonly("invariants", [](const PySimulation& self) {
        const PySimulation::InUse use(self);
        const std::vector<InvariantExcursion> all = self.simulation().invariants();
        py::list found;
        for (std::size_t i = 0; i < all.size(); ++i) {
          found.append(py::make_tuple(self.scenario().problem->info.invariants[i].name, array_of(all[i].initial),
                                      array_of(all[i].final), all[i].max_error));
        }
        return found;
      });
}

}  // namespace hamflow::python
