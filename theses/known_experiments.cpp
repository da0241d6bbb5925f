#include <algorithm>
#include <cctype>
#include <compare>

#include "experiment.hpp"
#include "experiment_list.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace reproduction {

namespace {
/// The parts of an ID such as "G2.8", by which experiments are sorted: the letter of the thesis, the kind (figure,
/// table or claim), and the numbers.
struct Place {
  char thesis;
  int kind;
  std::vector<int> numbers;
  std::string id;
  auto operator<=>(const Place&) const = default;
};

Place place_of(const ExperimentInfo& info) {
  Place place{info.thesis.front(), 0, {}, info.id};
  const bool starts_with_figure =
      info.id.size() > 1 && (info.id[0] == 'G' || info.id[0] == 'S') && std::isdigit(info.id[1]);
  place.kind = starts_with_figure ? 0 : info.id.starts_with("T") || info.id.starts_with("S-T") ? 1 : 2;
  int number = -1;
  for (const char c : info.id + " ") {
    if (std::isdigit(static_cast<unsigned char>(c))) {
      number = std::max(number, 0) * 10 + (c - '0');
    } else if (number >= 0) {
      place.numbers.push_back(number);
      number = -1;
    }
  }
  return place;
}
}  // namespace

const std::vector<Experiment>& all_experiments() {
  static const std::vector<Experiment> all = [] {
    std::vector<Experiment> sorted = generated_experiments();
    std::sort(sorted.begin(), sorted.end(),
              [](const Experiment& a, const Experiment& b) { return place_of(a.info) < place_of(b.info); });
    return sorted;
  }();
  return all;
}

const Experiment& experiment_of(const std::string& id) {
  const auto& all = all_experiments();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Experiment& e) { return e.info.id == id; });
  if (found == all.end()) throw Error("found experiment " + id + "; allowed one of hamflow list experiments");
  return *found;
}

Experiment drawing(const char* thesis, const std::string& id, const std::string& page, const std::string& title) {
  return {{id, thesis, page, title},
          [](Study& study) { study.nothing_to_test("drawing", "a drawing: it shows no number and no curve"); }};
}

}  // namespace reproduction

std::vector<ExperimentInfo> experiment_infos() {
  std::vector<ExperimentInfo> all;
  for (const auto& experiment : reproduction::all_experiments()) all.push_back(experiment.info);
  return all;
}

std::vector<std::string> named_experiments(const std::vector<std::string>& words) {
  const std::vector<ExperimentInfo> all = experiment_infos();
  std::vector<std::string> known{"all", "gross", "sonnleitner"};
  for (const ExperimentInfo& info : all) known.push_back(info.id);
  for (const std::string& word : words) {
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      throw Error("found experiment " + word +
                  "; allowed all, gross, sonnleitner, or an ID of hamflow list experiments" + suggestion(word, known));
    }
  }
  std::vector<std::string> ids;
  const auto asked = [&](const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  for (const ExperimentInfo& info : all) {
    const bool of_gross = info.thesis == reproduction::gross;
    if (asked("all") || asked(of_gross ? "gross" : "sonnleitner") || asked(info.id)) ids.push_back(info.id);
  }
  return ids;
}

}  // namespace hamflow
