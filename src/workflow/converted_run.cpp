#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "converted_text.hpp"
#include "csv_file.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/run/digits.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/workflow/convert.hpp"
#include "run_copy.hpp"
#include "run_description.hpp"
#include "run_file.hpp"
#include "run_keys.hpp"
#include "scenario_edit.hpp"
#include "summary.hpp"

namespace hamflow {

namespace fs = std::filesystem;

class ConvertedRun::Impl {
 public:
  Impl(const fs::path& file, const std::string& to) : file_(file), to_(to), samples_(read_run_file(file)) {
    if (samples_.energy.empty() && !samples_.t.empty()) {
      throw FileError(file.string() +
                      " cannot be converted: it holds the states of a reversal; allowed the run.h5 of a run");
    }
    const std::string& text = samples_.description.scenario;
    reading_ = read_scenario_text(text, file.string(), {});
    if (!reading_.scenario) {
      throw FileError("the scenario in " + file.string() + " is damaged: " + reading_.complaints.front().text());
    }
    check_states(scenario(), samples_, file);
    target_ = &in_coordinates(*scenario().problem, to);
    from_ = coordinates_of(*scenario().problem);
    digits_ = read_run_digits(file);
    if (!digits_.t.empty()) cut_to_equal_length();
    const std::vector<std::vector<double>> given_q = samples_.q;
    const std::vector<std::vector<double>> given_p = samples_.p;
    const RunDigits given_digits = digits_;
    const std::size_t size = target_->info.coordinates.size();
    for (auto* columns : {&samples_.q, &samples_.p}) columns->assign(size, std::vector<double>(samples_.t.size()));
    for (auto* columns : {&digits_.q, &digits_.p}) {
      if (!digits_.t.empty()) columns->assign(size, std::vector<std::string>(digits_.t.size()));
    }
    StateConverter convert(*scenario().problem, *target_, scenario().request.parameters);
    for (std::size_t k = 0; k < samples_.t.size(); ++k) {
      try {
        const CanonicalState state = convert({row_of(given_q, k), row_of(given_p, k)});
        for (std::size_t i = 0; i < state.q.size(); ++i) {
          samples_.q[i][k] = state.q[i];
          samples_.p[i][k] = state.p[i];
        }
        if (k < digits_.t.size()) convert_digits(k, state, {row_of(given_digits.q, k), row_of(given_digits.p, k)});
      } catch (const Error& error) {
        throw Error(fmt::format("sample {}, t = {}: {}", k, shortest(samples_.t[k]), error.what()));
      }
    }
    turn_ = std::max(convert.largest_turn(), fastest_turn(convert.turning()));
    turning_ = joined(convert.turning(), [this](std::size_t i) { return target_->info.coordinates[i]; });
  }

  std::string csv() const {
    const StateNames names = state_names(*target_, scenario().request.parameters, samples_.q.size());
    std::string text = fmt::format("t,{},{},energy\n", fmt::join(names.q, ","), fmt::join(names.p, ","));
    for (std::size_t k = 0; k < samples_.t.size(); ++k) {
      if (!digits_.t.empty()) {
        const DigitState s = digits_at(k);
        text += fmt::format("{},{},{},{}\n", digits_.t[k], fmt::join(s.q, ","), fmt::join(s.p, ","), digits_.energy[k]);
        continue;
      }
      const CanonicalState s = state_at(k);
      text += fmt::format("{:.17g}", samples_.t[k]);
      for (const double x : s.q) text += fmt::format(",{:.17g}", without_sign_of_nan(x));
      for (const double x : s.p) text += fmt::format(",{:.17g}", without_sign_of_nan(x));
      text += fmt::format(",{:.17g}\n", without_sign_of_nan(samples_.energy[k]));
    }
    return text;
  }
  std::string json() const {
    if (!digits_.t.empty()) {
      nlohmann::ordered_json all{{"coordinates", to_},
                                 {"t", digits_.t},
                                 {"q", nlohmann::ordered_json::array()},
                                 {"p", nlohmann::ordered_json::array()}};
      for (std::size_t k = 0; k < digits_.t.size(); ++k) {
        all["q"].push_back(digits_at(k).q);
        all["p"].push_back(digits_at(k).p);
      }
      all["energy"] = digits_.energy;
      return json_text(all);
    }
    nlohmann::ordered_json all{{"coordinates", to_},
                               {"t", samples_.t},
                               {"q", nlohmann::ordered_json::array()},
                               {"p", nlohmann::ordered_json::array()}};
    for (std::size_t k = 0; k < samples_.t.size(); ++k) {
      all["q"].push_back(state_at(k).q);
      all["p"].push_back(state_at(k).p);
    }
    all["energy"] = samples_.energy;
    return json_text(all);
  }
  std::string write_h5(const fs::path& target) const {
    const CanonicalState start = StateConverter(
        *scenario().problem, *target_, scenario().request.parameters)({scenario().start_q, scenario().start_p});
    std::string note;
    std::string text =
        "# Samples of a run in " + from_ + " coordinates, converted by hamflow convert to " + to_ + ".\n";
    const std::string same_settings = converted_text(scenario(), to_, start);
    if (read_scenario_text(same_settings, "the converted scenario", {}).scenario) {
      text += same_settings;
    } else {
      const std::string method = samples_.description.method;
      text += "# They were computed by " + method + ", with settings that these coordinates do not allow.\n";
      const std::string other = target_->constraint_form.empty() ? "cg" : "rattle";
      note = "the samples were computed by " + method + " with settings that " + to_ +
             " coordinates do not allow; the scenario in " + target.string() + " names " + other + " in double instead";
      Scenario changed = scenario();
      changed.text = edited_scenario(changed.text, {{"method", "{ name = \"" + other + "\" }"},
                                                    {run_path(run_keys().arithmetic), {}},
                                                    {run_path(run_keys().lattice), {}},
                                                    {run_path(run_keys().kernel), {}}});
      text += converted_text(changed, to_, start);
    }
    (void)accepted(read_scenario_text(text, "the converted scenario", {}));
    const std::size_t size = samples_.q.size();
    const StateNames names = state_names(*target_, scenario().request.parameters, size);
    const LeftOut left_out = copy_run_file(file_, target,
                                           {.scenario = text,
                                            .coordinates = names.q,
                                            .momenta = names.p,
                                            .q = samples_.q,
                                            .p = samples_.p,
                                            .digits = digits_,
                                            .digits_length = longest_digits(arithmetic())});
    if (!left_out.tables.empty()) {
      note += fmt::format("{}not in {}: {}, states of the run in {} coordinates", note.empty() ? "" : "; ",
                          target.string(), fmt::join(left_out.tables, ", "), from_);
    }
    if (!left_out.others.empty()) {
      note +=
          fmt::format("{}not in {}: {}", note.empty() ? "" : "; ", target.string(), fmt::join(left_out.others, ", "));
    }
    return note;
  }
  double turn() const { return turn_; }
  const std::string& turning() const { return turning_; }
  std::string left_out() const { return left_out_of_converted(scenario(), to_); }
  std::vector<std::string> columns_left_out() const {
    std::vector<std::string> all{"step"};
    for (const InvariantColumn& column : csv_columns(scenario())) all.push_back(column.name);
    return all;
  }

 private:
  const Scenario& scenario() const { return *reading_.scenario; }
  const std::string& arithmetic() const { return scenario().request.arithmetic; }
  /// In the run's arithmetic, with the whole turns that the doubles have been given.
  void convert_digits(std::size_t k, const CanonicalState& in_double, const DigitState& given) {
    DigitState state = in_chart_of(*target_, without_own_walls(*scenario().problem), scenario().request.parameters,
                                   arithmetic(), given);
    for (std::size_t i = 0; i < state.q.size(); ++i) {
      const auto& angles = target_->info.angles;
      if (std::find(angles.begin(), angles.end(), target_->info.coordinates[i]) != angles.end()) {
        const double missing = in_double.q[i] - evaluate_number<double>(state.q[i]);
        state.q[i] = turned(state.q[i], std::llround(missing / (2 * pi_value<double>())), arithmetic());
      }
      digits_.q[i][k] = state.q[i];
      digits_.p[i][k] = state.p[i];
      samples_.q[i][k] = evaluate_number<double>(state.q[i]);
      samples_.p[i][k] = evaluate_number<double>(state.p[i]);
    }
  }
  /// A run that goes on may have got a row between two looks.
  void cut_to_equal_length() {
    for (const auto* columns : {&digits_.q, &digits_.p}) {
      if (columns->size() != samples_.q.size()) {
        throw FileError(file_.string() + " is damaged: its states in /digits have another length than /q");
      }
    }
    const std::size_t rows = std::min(samples_.t.size(), digits_.t.size());
    const auto cut = [rows](auto&... columns) { (columns.resize(rows), ...); };
    cut(samples_.t, samples_.energy, digits_.t, digits_.energy);
    for (std::size_t i = 0; i < samples_.q.size(); ++i) cut(samples_.q[i], samples_.p[i], digits_.q[i], digits_.p[i]);
  }
  template <class T>
  static std::vector<T> row_of(const std::vector<std::vector<T>>& columns, std::size_t k) {
    std::vector<T> row;
    for (const std::vector<T>& column : columns) row.push_back(column[k]);
    return row;
  }
  DigitState digits_at(std::size_t k) const { return {row_of(digits_.q, k), row_of(digits_.p, k)}; }
  /// The rate of such an angle times the time to the next sample, at most: it shows whole turns.
  double fastest_turn(const std::vector<std::size_t>& angles) const {
    double most = 0;
    for (std::size_t k = 0; k + 1 < samples_.t.size() && !angles.empty(); ++k) {
      const CanonicalState s = state_at(k);
      const std::vector<double> rates = target_->rates(scenario().request.parameters, s.q, s.p);
      for (const std::size_t i : angles) {
        most = std::max(most, std::abs(rates[i] * (samples_.t[k + 1] - samples_.t[k])));
      }
    }
    return most;
  }
  CanonicalState state_at(std::size_t k) const { return {row_of(samples_.q, k), row_of(samples_.p, k)}; }

  fs::path file_;
  std::string to_;
  std::string from_;
  RunSamples samples_;
  RunDigits digits_;  // of the same samples; empty of a run in double
  Reading reading_;
  double turn_ = 0;
  std::string turning_;
  const ProblemEntry* target_ = nullptr;  // the problem in the coordinates `to`
};

ConvertedRun::ConvertedRun(const fs::path& run, const std::string& to)
    : impl_(std::make_unique<Impl>(fs::is_directory(run) ? run / "run.h5" : run, to)) {}
ConvertedRun::~ConvertedRun() = default;
std::string ConvertedRun::csv() const { return impl_->csv(); }
std::string ConvertedRun::json() const { return impl_->json(); }
std::string ConvertedRun::write_h5(const fs::path& target) const { return impl_->write_h5(target); }
double ConvertedRun::largest_turn() const { return impl_->turn(); }
const std::string& ConvertedRun::turning() const { return impl_->turning(); }
std::string ConvertedRun::left_out() const { return impl_->left_out(); }
std::vector<std::string> ConvertedRun::columns_left_out() const { return impl_->columns_left_out(); }

}  // namespace hamflow
