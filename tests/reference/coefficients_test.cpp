// The tables of coefficients: every name of the closed list is there, and its digits are those of the published set.
// What the digits are worth, order_conditions_test.cpp says.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "catalog_tables.hpp"  // generated
#include "hamflow/core/math.hpp"
#include "hamflow/detail/run/splitting_named.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

/// The row of coefficients.json of each composition and splitting of the closed list of names.
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
      {"ruth3", "Ruth83_3"},
      {"mclachlan-s2", "McLachlan95_S2"},
      {"mcate2", "McLachlanAtela92_2opt"},
      {"mcate3", "McLachlanAtela92_3opt"},
      {"mcate4", "McLachlanAtela92_4opt"},
      {"mcate5", "McLachlanAtela92_5opt"},
      {"mclachlan-s4", "McLachlan95_S4"},
      {"mclachlan-s5", "McLachlan95_S5"},
      {"blanes-moan-s6", "BlanesMoan02_S6"},
      {"blanes-moan-s10", "BlanesMoan02_S10"},
      {"sb3a-4", "McLachlan95_SB3A4"},
      {"sb3a-5", "McLachlan95_SB3A5"},
      {"calvo-sanz-serna4", "CalvoSanzSerna_4"},
      {"srkn6b", "BlanesMoan02_SRKN6b"},
      {"srkn11b", "BlanesMoan02_SRKN11b"},
      {"srkn14a", "BlanesMoan02_SRKN14a"},
      {"okunbor-skeel6", "OkunborSkeel94_m13"},
      {"rkn8-s19", "BlanesCasasEscorihuela22_RKN8_s19"},
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

/// Whether a coefficient is within `units` of a decimal place of the published digits. Fractions and closed forms are
/// evaluated in long double, which has 19 digits.
bool agrees(const std::string& text, const std::string& published, int place, int units) {
  if (text.find_first_not_of("-.0123456789") != std::string::npos) {
    const auto value = evaluate_number<long double>(text);
    const long double unit = larger(std::pow(10.0L, -place), 8 * std::numeric_limits<long double>::epsilon());
    return std::fabs(value - evaluate_number<long double>(published)) <= units * unit;
  }
  Wide difference = scaled(text) - scaled(published);
  if (difference < 0) difference = -difference;
  Wide unit = units;
  for (int k = place; k < places; ++k) unit *= 10;
  return difference <= unit;
}

int decimals(const std::string& text) {
  const auto point = text.find('.');
  return point == std::string::npos ? 0 : static_cast<int>(text.size() - point - 1);
}

/// The decimal place to which a published set is meant: that of its shortest coefficient, but 0.28 and 1 are exact.
int published_place(const std::vector<std::string>& published) {
  int place = places;
  for (const std::string& text : published) {
    if (decimals(text) >= 12) place = std::min(place, decimals(text));
  }
  return place;
}

nlohmann::json row_of(const std::string& name) {
  static const nlohmann::json file = reference_file("coefficients.json");
  for (const auto& set : file["sets"]) {
    if (rows().contains(name) && set["name"] == rows().at(name)) return set;
  }
  throw Error("a new table: name its row of coefficients.json here: " + name);
}

/// Of the refined digits, where the row has them, 36 decimal places; else all that were published.
void expect_digits(const std::vector<std::string>& found, const std::vector<std::string>& published, bool refined,
                   int units = 1) {
  ASSERT_LE(found.size(), published.size());
  const int place = refined ? places : published_place(published);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(agrees(found[i], published[i], place, units)) << found[i] << " against " << published[i];
  }
}

TEST(Coefficients, AgreementCountsDigits) {
  EXPECT_TRUE(agrees("1.25", "1.25", places, 1));
  EXPECT_TRUE(agrees("-0.12345678901234567890123456", "-0.12345678901234567890123457", 26, 1));
  EXPECT_FALSE(agrees("-0.12345678901234567890123456", "-0.12345678901234567890123457", 27, 1));
  EXPECT_FALSE(agrees("1.3512071919596576", "1.3512171919596576", 6, 1));
  EXPECT_TRUE(agrees("6/11", "0.545454545454545454545454545454545455", 36, 1));
  EXPECT_FALSE(agrees("6/11", "0.54545454545454554", 17, 1));
}

TEST(Coefficients, OfEveryNameOfTheClosedListAreThere) {
  for (const auto& [name, row] : rows()) EXPECT_EQ(find_method(name).name, name);
  for (const char* name : {"euler-a", "euler-b", "verlet", "pefrl", "chin4a", "chin4b"}) {
    EXPECT_EQ(find_method(name).name, name);
  }
  for (const CompositionTable* table : composition_tables()) {
    const std::string name(table->name);
    EXPECT_EQ(splitting_named(name)->table(), table);
    EXPECT_EQ(splitting_named(name + "-dkd")->table(), table);
  }
}

TEST(Coefficients, OfCompositionsAreThoseOfThePublishedSets) {
  for (const CompositionTable* table : composition_tables()) {
    if (table->half_count() == 0) continue;  // verlet has no coefficients
    const std::string name(table->name);
    SCOPED_TRACE(name);
    const nlohmann::json set = row_of(name);
    EXPECT_EQ(set["order"].get<int>(), table->order);
    EXPECT_EQ(set["stages"].get<int>(), table->stages());
    const bool refined = set.contains("refined_half_40digits");
    std::vector<std::string> found;
    for (int i = 0; i < table->half_count(); ++i) found.emplace_back(table->half[static_cast<std::size_t>(i)]);
    expect_digits(found, texts(refined ? set["refined_half_40digits"] : set["gamma"]), refined);
  }
}

TEST(Coefficients, OfSplittingsAreThoseOfThePublishedSets) {
  for (const SplittingTable* table : splitting_tables()) {
    const std::string name(table->name);
    if (name == "euler-a" || name == "euler-b" || name == "pefrl") continue;
    SCOPED_TRACE(name);
    const nlohmann::json set = row_of(name);
    EXPECT_EQ(set["order"].get<int>(), table->order);
    EXPECT_EQ(set["starts_with"].get<std::string>(), table->starts_with == StartsWith::kick ? "kick" : "drift");
    EXPECT_EQ(set["kind"].get<std::string>().starts_with("Runge-Kutta-Nystroem"), table->nystroem);
    const auto drifts = texts(set["a_drift"]);
    const auto kicks = texts(set["b_kick"]);
    ASSERT_EQ(static_cast<std::size_t>(table->count()), drifts.size() + kicks.size());
    std::vector<std::string> published;
    std::vector<std::string> found;
    for (int i = 0; i < table->count(); ++i) {
      const bool kick = (i % 2 == 0) == (table->starts_with == StartsWith::kick);
      published.push_back((kick ? kicks : drifts)[static_cast<std::size_t>(i / 2)]);
      found.emplace_back(table->coefficient(i));
    }
    // Of srkn14a the coefficients with 15 decimals meet the conditions to 4 units only.
    expect_digits(found, published, false, name == "srkn14a" ? 4 : 1);
  }
}

/// Omelyan, Mryglod and Folk give xi, lambda, chi; drifts and kicks follow.
TEST(Coefficients, OfPefrlAreThoseOfThePaper) {
  const SplittingTable& table = splittings::pefrl;
  EXPECT_TRUE(agrees(std::string(table.coefficient(0)), "0.1786178958448091", 16, 1));
  EXPECT_TRUE(agrees(std::string(table.coefficient(2)), "-0.06626458266981849", 17, 1));
  EXPECT_TRUE(agrees(std::string(table.coefficient(3)), "-0.2123418310626054", 16, 1));
}

TEST(Coefficients, Yoshida8IsSolutionD) { EXPECT_EQ(compositions::yoshida8.half, compositions::yoshida8d.half); }

TEST(Coefficients, AWrongDigitAtTheTwentiethPlaceIsSeen) {
  // What a coefficient typed as a double would be.
  const std::string digits(compositions::yoshida6.half[1]);
  const std::string typed = shortest(std::strtod(digits.c_str(), nullptr));
  EXPECT_FALSE(agrees(typed, digits, 20, 1));
  EXPECT_TRUE(agrees(typed, digits, 15, 1));
}

}  // namespace
}  // namespace hamflow::test
