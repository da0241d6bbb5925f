// The tables of coefficients: their digits against the published sets, their order conditions in both arithmetics.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "../support/near.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

/// The row of coefficients.json of each composition of the closed list of names.   [spec: methods]
const std::map<std::string, std::string>& rows() {
  static const std::map<std::string, std::string> all{
      {"stv4", "StV4_triple_jump (Forest-Ruth/Candy-Rozmus/Yoshida4)"},
      {"suzuki4", "Suzuki4_s5"},
      {"mclachlan4-s5", "McLachlan95_SS5"},
      {"yoshida6", "Yoshida6A_s7"},
      {"yoshida6b", "Yoshida6B_s7"},
      {"yoshida6c", "Yoshida6C_s7"},
      {"kahan-li6", "KahanLi6_s9odr6a"},
      {"mclachlan6-s9", "McLachlan95_SS9"},
      {"sofroniou6", "SofroniouSpaletta05_s13odr6"},
      {"yoshida8", "Yoshida8D_s15"},
      {"yoshida8a", "Yoshida8A_s15"},
      {"yoshida8b", "Yoshida8B_s15"},
      {"yoshida8c", "Yoshida8C_s15"},
      {"yoshida8d", "Yoshida8D_s15"},
      {"yoshida8e", "Yoshida8E_s15"},
      {"suzuki-umeno8", "Suzuki-Umeno93/McLachlan95_SS15"},
      {"mclachlan8", "McLachlan95_SS17"},
      {"kahan-li8", "KahanLi8_s17odr8a"},
      {"sofroniou8", "SofroniouSpaletta05_s21odr8"},
      {"kahan-li10", "KahanLi/Hairer s33odr10c (JANUS order 10)"},
      {"sofroniou10", "SofroniouSpaletta05_s35odr10"},
  };
  return all;
}

__extension__ typedef __int128 Wide;
constexpr int places = 36;

/// A decimal literal times 10^36, digits beyond that cut off.
Wide scaled(const std::string& text) {
  Wide value = 0;
  int after_point = -1;
  for (const char c : text) {
    if (c == '.') {
      after_point = 0;
    } else if (c >= '0' && c <= '9' && after_point < places) {
      value = 10 * value + (c - '0');
      if (after_point >= 0) ++after_point;
    }
  }
  for (int k = std::max(after_point, 0); k < places; ++k) value *= 10;
  return text.front() == '-' ? -value : value;
}

/// How many decimal places of two literals agree, up to a unit of the last one.
int common_places(const std::string& a, const std::string& b) {
  Wide difference = scaled(a) - scaled(b);
  if (difference < 0) difference = -difference;
  int common = places;
  for (Wide unit = 1; common > 0 && difference > unit; unit *= 10) --common;
  return common;
}

std::vector<const CompositionTable*> tables() {
  std::vector<const CompositionTable*> all;
  for (const MethodEntry& entry : methods()) {
    if (entry.composition != nullptr && entry.starts_with == StartsWith::kick) all.push_back(entry.composition);
  }
  return all;
}

TEST(Coefficients, CommonPlacesCountsDigits) {
  EXPECT_EQ(common_places("1.25", "1.25"), places);
  EXPECT_EQ(common_places("-0.12345678901234567890123456", "-0.12345678901234567890123457"), 26);
  EXPECT_EQ(common_places("1.3512071919596576", "1.3512071919596577"), 16);
  EXPECT_EQ(common_places("1.3512071919596576", "1.3512171919596576"), 5);
}

TEST(Coefficients, DigitsAreThoseOfThePublishedSets) {
  const nlohmann::json file = reference_file("coefficients.json");
  for (const CompositionTable* table : tables()) {
    const std::string name(table->name);
    if (table->half_count() == 0) continue;  // verlet has no coefficients
    SCOPED_TRACE(name);
    ASSERT_TRUE(rows().contains(name)) << "a new table: name its row of coefficients.json here";
    nlohmann::json set;
    for (const auto& s : file["sets"]) {
      if (s["name"] == rows().at(name)) set = s;
    }
    ASSERT_FALSE(set.is_null());
    EXPECT_EQ(set["order"].get<int>(), table->order);
    EXPECT_EQ(set["stages"].get<int>(), table->stages());
    const auto gamma = texts(set.contains("refined_half_40digits") ? set["refined_half_40digits"] : set["gamma"]);
    for (int i = 0; i < table->half_count(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const std::string digits(table->half[at]);
      // At least 25 places, or as many as were published.
      const auto published = static_cast<int>(gamma[at].size() - gamma[at].find('.') - 1);
      EXPECT_GE(common_places(digits, gamma[at]), std::min(25, published)) << digits << " against " << gamma[at];
    }
  }
}

template <class R>
struct Conditions {
  R first = R(0), third = R(0), fifth = R(0), mixed = R(0);
};

/// sum gamma, sum gamma^3, sum gamma^5 and sum gamma_k^3 (gamma_1 + ... + gamma_k/2)^2: symmetric compositions of a
/// symmetric basic step have order 4 if the second vanishes, and 6 if all but the first do.   [HLW2006, V.3.2]
template <class R>
Conditions<R> conditions_of(const CompositionTable& table) {
  Conditions<R> found;
  R before(0);
  for (const R& g : composition_weights<R>(table)) {
    const R middle = before + g / R(2);
    found.first += g;
    found.third += g * g * g;
    found.fifth += g * g * g * g * g;
    found.mixed += g * g * g * middle * middle;
    before += g;
  }
  return found;
}

template <class R>
void check_conditions() {
  for (const CompositionTable* table : tables()) {
    SCOPED_TRACE(std::string(table->name));
    const Conditions<R> found = conditions_of<R>(*table);
    R size(0);  // of the terms: each gamma is rounded once, relatively
    for (const R& g : composition_weights<R>(*table)) size += std::pow(std::fabs(g), R(5)) + std::fabs(g);
    const R rounding = 16 * std::numeric_limits<R>::epsilon() * size;
    EXPECT_TRUE(within(found.first, 1, rounding));
    EXPECT_EQ(std::fabs(found.third) <= rounding, table->order >= 4) << static_cast<double>(found.third);
    if (table->order >= 6) {
      EXPECT_TRUE(within(found.fifth, 0, rounding));
      EXPECT_TRUE(within(found.mixed, 0, rounding));
    } else {
      // The order claimed is not one too low either.
      EXPECT_GT(larger(std::fabs(found.fifth), std::fabs(found.mixed)), R(1e-3));
    }
    const auto gamma = composition_weights<R>(*table);
    for (std::size_t i = 0; i < gamma.size(); ++i) EXPECT_EQ(gamma[i], gamma[gamma.size() - 1 - i]);
    for (const StartsWith starts : {StartsWith::kick, StartsWith::drift}) {
      const auto sequence = sequence_of<R>(*table, starts).coefficients;
      for (std::size_t i = 0; i < sequence.size(); ++i) EXPECT_EQ(sequence[i], sequence[sequence.size() - 1 - i]);
    }
  }
}

TEST(Coefficients, MeetTheOrderConditionsInDouble) { check_conditions<double>(); }
TEST(Coefficients, MeetTheOrderConditionsInLongDouble) { check_conditions<long double>(); }

TEST(Coefficients, AWrongDigitAtTheTwentiethPlaceIsSeen) {
  // In long double; what a coefficient typed as a double would be.
  CompositionTable wrong = *find_method("yoshida6").composition;
  const std::string digits = shortest(std::strtod(std::string(wrong.half[1]).c_str(), nullptr));
  wrong.half[1] = digits;
  EXPECT_GT(std::fabs(conditions_of<long double>(wrong).third), 64 * long_epsilon);
  EXPECT_LT(std::fabs(conditions_of<double>(wrong).third), 64 * epsilon);
}

}  // namespace
}  // namespace hamflow::test
