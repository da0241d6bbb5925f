// [Gross1999, Sect. 3.2.3]: figures 3.27 and 3.28: conditions of the tangent K_T and of M^-1, and det K_T, over time,
// in absolute and in relative angles. Iterations: G-C.
#include <algorithm>

#include "../experiment.hpp"
#include "../pendulum_runs.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"

namespace hamflow::reproduction {

namespace pendulum_conditions {

Trajectory run(Study& study, bool absolute) {
  return pendulum_run(study, absolute ? "absolute" : "relative", absolute, "method.diagnostics=true");
}

/// The steps at which a quantity is larger than at both neighbours and above the middle of its range.
std::vector<std::size_t> peaks(const std::vector<double>& x) {
  double low = x[1], high = x[1];  // the start has no step before it
  for (std::size_t k = 1; k < x.size(); ++k) {
    low = std::min(low, x[k]);
    high = std::max(high, x[k]);
  }
  std::vector<std::size_t> all;
  for (std::size_t k = 2; k + 1 < x.size(); ++k) {
    if (x[k] > (low + high) / 2 && x[k] >= x[k - 1] && x[k] > x[k + 1]) all.push_back(k);
  }
  return all;
}

/// The largest value, and that over the smallest, in the window that ends with each step.
struct Rise {
  std::vector<double> largest, rise;
};
Rise rise_of(const std::vector<double>& x) {
  double low = x[1], high = x[1];  // the start has no step before it
  Rise all{{high}, {1}};
  for (std::size_t k = 1; k < x.size(); ++k) {
    low = std::min(low, x[k]);
    high = std::max(high, x[k]);
    all.largest.push_back(high);
    all.rise.push_back(high / low);
  }
  return all;
}

/// a/b for every window that shows two peaks at least, as the figures do whose window is not known: least and most.
struct Ratios {
  double least = 1e300, most = 0;
  std::string windows;
};
Ratios ratios(const std::vector<double>& a, const std::vector<double>& b, const std::vector<std::size_t>& peaks,
              const std::vector<double>& t) {
  Ratios all;
  const std::size_t first = peaks.size() < 2 ? a.size() : peaks[1] + 1;
  for (std::size_t k = first; k < a.size(); ++k) {
    all.least = std::min(all.least, a[k] / b[k]);
    all.most = std::max(all.most, a[k] / b[k]);
  }
  if (first == a.size()) return {std::nan(""), std::nan(""), "no window shows two peaks"};
  all.windows = fmt::format("windows that end between t = {:.4g}, after the second peak, and 26", t[first]);
  return all;
}

/// The largest distance, in steps, of one of some peaks from the nearest of others.
double apart(const std::vector<std::size_t>& some, const std::vector<std::size_t>& others) {
  if (some.empty() || others.empty()) return std::nan("");
  double most = 0;
  for (const std::size_t k : some) {
    double nearest = 1e9;
    for (const std::size_t j : others) nearest = std::min(nearest, std::abs(double(k) - double(j)));
    most = std::max(most, nearest);
  }
  return most;
}

/// Passages of the rods through one line, where sin(q1 - q2) = 0: M is worst conditioned there.
double passages(const Trajectory& absolute) {
  double count = 0;
  for (std::size_t k = 1; k < absolute.size(); ++k) {
    const auto sine = [&](std::size_t j) { return std::sin(absolute.q[j][0] - absolute.q[j][1]); };
    if ((sine(k) < 0) != (sine(k - 1) < 0)) ++count;
  }
  return count;
}

/// How many peaks the figure shows depends on the end of its time axis, which nobody knows.
void claim_two_peaks(Study& study, const Trajectory& run, const std::vector<std::size_t>& peaks, double passages) {
  const double count = static_cast<double>(peaks.size());
  const std::string two_are_seen =
      peaks.size() < 3 ? "never 2 alone"
                       : fmt::format("2 if it ends between t = {:.4g} and {:.4g}", run.t[peaks[1]], run.t[peaks[2]]);
  study.claim(
      {"peaks_in_the_window",
       "in the window of figure 3.27 the conditions of K_T and of M^-1 rise almost by jumps at two times",
       "zwei Zeitpunkte", "124"},
      within(2, 0.5, "a count"),
      {{count / 2, count / 2,
        fmt::format("0 to {:.0f} peaks of cond(M^-1), as the window ends anywhere up to t = 26, the end of figures "
                    "3.21 to 3.26: {}",
                    count, two_are_seen)}},
      Grounds::program, "the end of the figure's time axis, which is not legible");
  study.note(fmt::format(
      "Up to t = 26 cond(M^-1) has {:.0f} peaks, and the rods pass {:.0f} times through one line, where M is "
      "worst conditioned, sin(q1 - q2) = 0.",
      count, passages));
}

/// Of both figures.
void claim_determinants(Study& study, const Trajectory& absolute, const Trajectory& relative,
                        const std::vector<std::size_t>& of_mass) {
  double gap = 0, least = 1e300, largest = 0;
  for (std::size_t k = 1; k < absolute.size(); ++k) {
    gap = std::max(gap, std::abs(absolute.determinant_tangent[k] / relative.determinant_tangent[k] - 1));
    least = std::min(least, absolute.determinant_tangent[k]);
    largest = std::max(largest, absolute.determinant_tangent[k]);
  }
  study.claim({"same_determinant", "the determinants of K_T are the same in absolute and in relative angles",
               "identisch", "126"},
              at_most(1e-9, "the two matrices K_T are similar: rounding"),
              {{gap, 1e-14, "largest relative difference over every step"}});
  std::vector<double> depth;
  for (const double det : absolute.determinant_tangent) depth.push_back(-det);
  // The range of -det is negative; peaks() takes the middle of it.
  const auto falls = peaks(depth);
  study.claim({"determinant_falls", "det K_T falls abruptly at the times at which the conditions rise",
               "schlagartiges Fallen", "126"},
              at_most(1, "one step: K_T is an average over the step that ends at that time"),
              {{apart(of_mass, falls), 0,
                fmt::format("largest distance in steps of {} falls from {} peaks; det K_T from {:.6g} to {:.6g}",
                            falls.size(), of_mass.size(), least, largest)}});
}

/// The whole run, and the window in which two peaks stand, as the thesis tells of its figure.
figures::Page page_of(const std::string& title, const std::vector<double>& t,
                      const std::array<std::vector<double>, 3>& x) {
  constexpr const char* labels[] = {"cond({/:Italic K}_T)", "cond({/:Italic M}^{-1})", "det({/:Italic K}_T)"};
  const auto in_window = std::upper_bound(t.begin(), t.end(), 3 + 1e-9) - t.begin();
  const auto opening = [&](const std::vector<double>& all) {
    return std::vector<double>(all.begin(), all.begin() + in_window);
  };
  figures::Page page{title, {}, 2, figures::two_columns};
  for (std::size_t i = 0; i < 3; ++i) {
    page.panels.push_back(over_time(labels[i], t, x[i]));
    page.panels.push_back(over_time(labels[i], opening(t), opening(x[i])));
  }
  return page;
}

void carry_out(Study& study, bool absolute) {
  const Trajectory own = run(study, absolute), other = run(study, !absolute);
  const auto of_mass = peaks(own.condition_inverse_mass);
  if (absolute) claim_two_peaks(study, own, of_mass, passages(own));
  if (absolute) {
    const auto of_tangent = peaks(own.condition_tangent);
    study.claim(
        {"same_times", "the conditions of K_T and of M^-1 rise at the same times", "zu diesen Zeitpunkten", "124"},
        at_most(1, "one step: K_T is an average over the step that ends at that time"),
        {{apart(of_mass, of_tangent), 0, "largest distance in steps of a peak of cond(M^-1) from those of cond(K_T)"}});
    study.note(
        fmt::format("cond(K_T) has {} peaks above the middle of its range: it shares {} of them with cond(M^-1); "
                    "most of these have two lower peaks beside them, about 0.1 before and after.",
                    of_tangent.size(), of_mass.size()));
    const Ratios rises =
        ratios(rise_of(own.condition_tangent).rise, rise_of(own.condition_inverse_mass).rise, of_mass, own.t);
    study.claim({"damped", "in absolute angles the condition of K_T rises less than that of M^-1", "niedriger", "124"},
                at_most(1, "ratio of the two rises, each the largest over the smallest value"),
                {{rises.most, 1e-6, "largest of all " + rises.windows}});
  } else {
    const Rise tangent = rise_of(own.condition_tangent), other_tangent = rise_of(other.condition_tangent);
    const Ratios rises = ratios(tangent.rise, other_tangent.rise, of_mass, own.t);
    study.claim(
        {"rises_less", "in relative angles the condition of K_T hardly rises: less than in absolute ones",
         "kaum ein Anstieg", "125"},
        at_most(1, "ratio of the two rises, each the largest over the smallest value; \"hardly\" has no number"),
        {{rises.most, 1e-6,
          fmt::format("largest of all {}, up to which it rises by {:.3g}, in absolute angles by {:.3g}", rises.windows,
                      tangent.rise.back(), other_tangent.rise.back())}});
    const Ratios of_inverse_mass =
        ratios(rise_of(own.condition_inverse_mass).rise, rise_of(other.condition_inverse_mass).rise, of_mass, own.t);
    study.claim({"mass_rises_more", "in relative angles the condition of M^-1 rises more than in absolute ones",
                 "stärker", "125"},
                at_least(1, "ratio of the two rises, each the largest over the smallest value"),
                {{of_inverse_mass.least, 1e-6, "smallest of all " + of_inverse_mass.windows}});
    double worse = 0;
    for (std::size_t k = 1; k < own.size(); ++k) worse += own.condition_tangent[k] > other.condition_tangent[k] ? 1 : 0;
    const Ratios largest = ratios(tangent.largest, other_tangent.largest, of_mass, own.t);
    study.claim({"better", "in relative angles the linear system of Newton's method is better conditioned",
                 "besser konditioniert", "125"},
                at_most(1, "ratio of the largest cond(K_T) in relative and in absolute angles"),
                {{largest.most, 1e-6, "largest of all " + largest.windows}});
    study.note(fmt::format("In {:.3g} of the steps cond(K_T) is larger in relative angles; only its peaks are lower.",
                           worse / static_cast<double>(own.size() - 1)));
  }
  if (absolute) claim_determinants(study, own, other, of_mass);
  const std::vector<double> t(own.t.begin() + 1, own.t.end());
  const auto tail = [](const std::vector<double>& x) { return std::vector<double>(x.begin() + 1, x.end()); };
  study.keep({"conditions",
              {{"t", t},
               {"condition_tangent", tail(own.condition_tangent)},
               {"condition_inverse_mass", tail(own.condition_inverse_mass)},
               {"determinant_tangent", tail(own.determinant_tangent)},
               {"iterations", tail(own.iterations)}}});
  study.draw(
      "figure",
      study.info().title +
          ": condition of K_T, condition of M^-1 and det K_T at every step; on the left up to t = 26, on the right "
          "up to t = 3, with two peaks",
      page_of(study.info().title, t,
              {tail(own.condition_tangent), tail(own.condition_inverse_mass), tail(own.determinant_tangent)}));
}

}  // namespace pendulum_conditions

std::vector<Experiment> pendulum_conditions_experiments() {
  return {{{"G3.27", gross, "125", "condition of the nonlinear double pendulum, absolute angles"},
           [](Study& study) { pendulum_conditions::carry_out(study, true); }},
          {{"G3.28", gross, "126", "condition of the nonlinear double pendulum, relative angles"},
           [](Study& study) { pendulum_conditions::carry_out(study, false); }}};
}

}  // namespace hamflow::reproduction
