#include "hamflow/orbits/orbit.hpp"

#include <cmath>
#include <numbers>

#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {

struct Given {
  const char* key;
  const std::optional<double>& value;
};

class OrbitReader {
 public:
  explicit OrbitReader(const Orbit<double>& orbit) : orbit_(orbit) {
    numbers_are_finite();
    if (!complaints.empty()) return;
    at_most_one({{"a", orbit.a}, {"period", orbit.period}, {"pericentre_distance", orbit.pericentre_distance}});
    at_most_one({{"pericentre", orbit.pericentre}, {"longitude_of_pericentre", orbit.longitude_of_pericentre}});
    at_most_one({{"mean_anomaly", orbit.mean_anomaly},
                 {"true_anomaly", orbit.true_anomaly},
                 {"eccentric_anomaly", orbit.eccentric_anomaly},
                 {"mean_longitude", orbit.mean_longitude},
                 {"time_of_pericentre", orbit.time_of_pericentre}});
    shape();
    size();
    place();
  }

  std::vector<Complaint> complaints;

 private:
  void complain(const std::string& key, const std::string& message) {
    complaints.push_back({.key = key, .message = message});
  }

  void numbers_are_finite() {
    const std::optional<double> e = orbit_.e;
    const std::optional<double> inclination = orbit_.inclination;
    const std::optional<double> node = orbit_.node;
    const Given all[] = {{"a", orbit_.a},
                         {"period", orbit_.period},
                         {"pericentre_distance", orbit_.pericentre_distance},
                         {"e", e},
                         {"inclination", inclination},
                         {"node", node},
                         {"pericentre", orbit_.pericentre},
                         {"longitude_of_pericentre", orbit_.longitude_of_pericentre},
                         {"mean_anomaly", orbit_.mean_anomaly},
                         {"true_anomaly", orbit_.true_anomaly},
                         {"eccentric_anomaly", orbit_.eccentric_anomaly},
                         {"mean_longitude", orbit_.mean_longitude},
                         {"time_of_pericentre", orbit_.time_of_pericentre}};
    for (const Given& one : all) {
      if (one.value && !std::isfinite(*one.value)) {
        complain(one.key, "found " + shortest(*one.value) + "; allowed a finite number");
      }
    }
  }

  /// If several are given, the error is reported for the last one.
  void at_most_one(const std::vector<Given>& all) {
    std::vector<std::string> found;
    for (const Given& one : all) {
      if (one.value) found.emplace_back(one.key);
    }
    if (found.size() < 2) return;
    const std::string last = found.back();
    found.pop_back();
    complain(last, "found " + joined(found) + " and " + last + "; allowed one of them");
  }

  std::string with_e() const { return " with e = " + shortest(orbit_.e); }

  void shape() {
    if (orbit_.e < 0) complain("e", "found " + shortest(orbit_.e) + "; allowed a number from 0");
    if (!(orbit_.inclination >= 0 && orbit_.inclination <= std::numbers::pi)) {
      complain("inclination", "found " + shortest(orbit_.inclination) +
                                  " radians; allowed 0 to pi (retrograde orbits: more than pi/2)");
    }
  }

  void size() {
    if (!orbit_.a && !orbit_.period && !orbit_.pericentre_distance) {
      complain("a", "found no size of the orbit; allowed one of a, period, pericentre_distance");
    }
    if (orbit_.a && orbit_.e == 1) complain("a", "found a with e = 1; allowed pericentre_distance");
    if (orbit_.period && !(orbit_.e < 1)) {
      complain("period", "found a period" + with_e() + "; allowed pericentre_distance" +
                             (orbit_.e > 1 ? ", or a, which is negative on a hyperbola" : ""));
    }
    if (orbit_.a && orbit_.e > 1 && !(*orbit_.a < 0)) {
      complain("a", "found " + shortest(*orbit_.a) + with_e() + "; allowed a number below 0 (hyperbola), or e below 1");
    }
    if (orbit_.a && orbit_.e < 1 && !(*orbit_.a > 0)) {
      complain("a", "found " + shortest(*orbit_.a) + with_e() + "; allowed a number above 0 (ellipse), or e above 1");
    }
    positive("period", orbit_.period);
    positive("pericentre_distance", orbit_.pericentre_distance);
  }

  void positive(const std::string& key, const std::optional<double>& value) {
    if (value && !(*value > 0)) complain(key, "found " + shortest(*value) + "; allowed a number above 0");
  }

  void place() {
    if (orbit_.e == 1) {
      for (const Given& one :
           {Given{"mean_anomaly", orbit_.mean_anomaly}, Given{"eccentric_anomaly", orbit_.eccentric_anomaly},
            Given{"mean_longitude", orbit_.mean_longitude}}) {
        if (one.value) {
          complain(one.key, std::string("found ") + one.key + " with e = 1; allowed true_anomaly, time_of_pericentre");
        }
      }
    }
    if (orbit_.true_anomaly && orbit_.e >= 1) {
      const double asymptote = std::numbers::pi - std::acos(1 / orbit_.e);
      const double anomaly = std::remainder(*orbit_.true_anomaly, 2 * std::numbers::pi);
      if (!(std::abs(anomaly) < asymptote)) {
        complain("true_anomaly", "found " + shortest(*orbit_.true_anomaly) + with_e() + "; allowed angles between -" +
                                     shortest(asymptote) + " and " + shortest(asymptote) +
                                     ", where the asymptotes are");
      }
    }
  }

  const Orbit<double>& orbit_;
};

}  // namespace

std::vector<Complaint> complaints_about(const Orbit<double>& orbit) { return OrbitReader(orbit).complaints; }

}  // namespace hamflow
