// Compositions of Kepler drifts A and kicks B by the planets, B smaller than A by a factor e, the mass of the planets.
// The error of a step is e dt^p + e^2 dt^q + e^3 dt^r: the numbers in a name are p, q, r.
#pragma once

#include <string_view>
#include <vector>

namespace hamflow {

/// A symmetric composition A(a_1 dt) B(b_1 dt) A(a_2 dt) ... A(a_1 dt): the first half of each list, middle included.
struct KeplerTable {
  std::string_view name;
  int order;  // whatever the masses
  const char* reference;
  std::size_t kicks;
  std::vector<const char*> drifts_by;  // a
  std::vector<const char*> kicks_by;   // b

  std::size_t drift_index(std::size_t k) const { return k <= kicks - k ? k : kicks - k; }
  std::size_t kick_index(std::size_t k) const { return k <= kicks - 1 - k ? k : kicks - 1 - k; }
};

/// saba(1) ... saba(4): nodes and weights of Gauss.   [LaskarRobutel2001]
/// saba(8,4), saba(8,6,4), saba(10,6,4): [BlanesEtAl2013; FarresEtAl2013], 39 digits that solve the order conditions
/// (b_4 of ABA864 as printed does so to 29 digits).
inline const std::vector<KeplerTable>& kepler_tables() {
  static const std::vector<KeplerTable> all{
      {"1", 2, "LaskarRobutel2001", 1, {"1/2"}, {"1"}},
      {"2", 2, "LaskarRobutel2001", 2, {"1/2 - sqrt(3)/6", "sqrt(3)/3"}, {"1/2"}},
      {"3", 2, "LaskarRobutel2001", 3, {"1/2 - sqrt(15)/10", "sqrt(15)/10"}, {"5/18", "4/9"}},
      {"4",
       2,
       "LaskarRobutel2001",
       4,
       {"1/2 - sqrt(525 + 70*sqrt(30))/70", "(sqrt(525 + 70*sqrt(30)) - sqrt(525 - 70*sqrt(30)))/70",
        "sqrt(525 - 70*sqrt(30))/35"},
       {"1/4 - sqrt(30)/72", "1/4 + sqrt(30)/72"}},
      {"8,4",
       4,
       "BlanesEtAl2013, ABA84",
       5,
       {"0.07534696026989288841652780368347446437265", "0.5179168546882567823007739784963156443238",
        "1/2 - (0.07534696026989288841652780368347446437265 + 0.5179168546882567823007739784963156443238)"},
       {"0.1902259393736766192452307627384538974612", "0.8465240704435262570550805446467758341771",
        "1 - 2*(0.1902259393736766192452307627384538974612 + 0.8465240704435262570550805446467758341771)"}},
      {"8,6,4",
       4,
       "BlanesEtAl2013, ABA864",
       7,
       {"0.0711334264982231177779387300061549964174", "0.241153427956640098736487795326289649618",
        "0.521411761772814789212136078067994229991", "-0.333698616227678005726562603400438876027"},
       {"0.183083687472197221961703757166430291072", "0.310782859898574869507522291054262796375",
        "-0.0265646185119588006972121379164987592663", "0.0653961422823734184559721793916113436371"}},
      {"10,6,4",
       4,
       "BlanesEtAl2013, ABA1064",
       8,
       {"0.03809449742241219545697532230863756534060", "0.1452987161169137492940200726606637497442",
        "0.2076276957255412507162056113249882065158", "0.4359097036515261592231548624010651844006",
        "-0.6538612258327867093807117373907094120024"},
       {"0.09585888083707521061077150377145884776921", "0.2044461531429987806805077839164344779763",
        "0.2170703479789911017143385924306336714532", "-0.01737538195906509300561788011852699719871"}}};
  return all;
}

}  // namespace hamflow
