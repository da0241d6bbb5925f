// Reads [problem].bodies and [problem].units of n-body.
#include <algorithm>

#include "body_list.hpp"
#include "hamflow/detail/problems/body_keys.hpp"
#include "method_keys.hpp"
#include "run_keys.hpp"
#include "scenario_reader.hpp"
#include "start_keys.hpp"

namespace hamflow {

namespace {

constexpr const char* angle_forms =
    "; allowed a number in radians, or a text such as \"20 deg\", \"1.5 rad\", \"pi/3\"";

bool is_vector_key(const std::string& key) { return key == BodyKeys::position || key == BodyKeys::velocity; }

/// Whether a key belongs to the orbit of a body.
bool is_orbit_key(const std::string& key) {
  return key != BodyKeys::name && key != BodyKeys::mass && key != BodyKeys::primary && !is_vector_key(key);
}

/// Reads one body of the list.
class BodyReader {
 public:
  BodyReader(TomlTable& table, std::size_t index, const std::vector<ListedBody>& before)
      : table_(table), index_(index), before_(before) {}

  ListedBody read() {
    body_.name = "body" + std::to_string(index_ + 1);
    for (const OptionInfo& key : body_keys()) {
      if (key.name == BodyKeys::name) {
        read_name(key);
      } else if (key.name == BodyKeys::mass) {
        body_.mass = table_.text(key).value_or("0");
      } else if (is_orbit_key(key.name)) {
        read_number(key);
      } else {
        table_.know(key.name);
      }
    }
    read_vectors();
    read_primary();
    if (!body_.orbit.empty() && is_sound_) complain_of_orbit();
    table_.finish();
    return body_;
  }

 private:
  void complain(const std::string& key, const std::string& message) {
    table_.complain(key, message);
    is_sound_ = false;
  }

  void read_name(const OptionInfo& key) {
    const auto name = table_.text(key);
    if (!name) return;
    constexpr const char* characters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_- ";
    if (name->find_first_not_of(characters) != std::string::npos || name->front() == ' ' || name->back() == ' ') {
      complain(key.name, "found the name \"" + *name + "\"; allowed letters, digits, _, - and spaces between them");
    } else if (*name == BodyKeys::jacobi || *name == BodyKeys::barycentre) {
      complain(key.name, "found the name \"" + *name + "\", which is a word for a primary; allowed another name");
    } else if (index_of(*name)) {
      complain(key.name, "found the name \"" + *name + "\" of " + std::string("bodies[") +
                             std::to_string(*index_of(*name)) + "] again; allowed a name for each body");
    }
    body_.name = *name;
  }

  void read_number(const OptionInfo& key) {
    const auto text = is_angle_key(key.name) ? table_.plain_string(key.name) : std::nullopt;
    if (text) {
      if (const auto angle = angle_in_radians(*text)) {
        body_.orbit[key.name] = *angle;
      } else {
        complain(key.name, "found \"" + *text + "\"" + angle_forms);
      }
    } else if (table_.has(key.name)) {
      OptionInfo any = key;
      any.range = Range::any;  // what is wrong with an orbit has sentences of its own
      if (const auto number = table_.text(any)) {
        body_.orbit[key.name] = *number;
      } else {
        is_sound_ = false;
      }
    } else {
      table_.know(key.name);
    }
  }

  void read_vectors() {
    const bool has_position = table_.has(BodyKeys::position);
    const bool has_velocity = table_.has(BodyKeys::velocity);
    const std::string first_of_orbit = first_orbit_key();
    if (has_position != has_velocity) {
      const char* const given = has_position ? BodyKeys::position : BodyKeys::velocity;
      const char* const other = has_position ? BodyKeys::velocity : BodyKeys::position;
      complain(given, std::string("found ") + given + " without " + other + "; allowed both, or an orbit");
      return;
    }
    if (has_position) {
      if (!first_of_orbit.empty()) {
        complain(first_of_orbit, "found " + first_of_orbit + " together with position; allowed an orbit, or position " +
                                     "and velocity");
      }
      for (const char* key : {BodyKeys::position, BodyKeys::velocity}) {
        auto numbers = table_.numbers({.name = key, .type = OptionType::list});
        if (!numbers) {
          is_sound_ = false;
        } else if (numbers->size() != 2 && numbers->size() != 3) {
          complain(key, "found " + std::to_string(numbers->size()) + (numbers->size() == 1 ? " entry" : " entries") +
                            "; allowed 2 numbers in the plane, 3 in space");
        } else {
          (key == std::string(BodyKeys::position) ? body_.position : body_.velocity) = *numbers;
        }
      }
      if (is_sound_ && body_.position.size() != body_.velocity.size()) {
        complain(BodyKeys::velocity, "found " + std::to_string(body_.velocity.size()) + " entries; allowed " +
                                         std::to_string(body_.position.size()) + ", as position has");
      }
    } else if (index_ == 0 && !first_of_orbit.empty()) {
      complain(first_of_orbit, "found " + first_of_orbit +
                                   " of the first body, before which there is no body that its orbit is about; allowed "
                                   "position and velocity, or neither: the origin, at rest");
    } else if (index_ > 0 && first_of_orbit.empty()) {
      complain("a", "found neither an orbit nor a position; allowed a, period or pericentre_distance with e, " +
                        std::string("inclination, ..., or position and velocity"));
    }
  }

  std::string first_orbit_key() const {
    for (const OptionInfo& key : body_keys()) {
      if (is_orbit_key(key.name) && table_.has(key.name)) return key.name;
    }
    return {};
  }

  std::optional<std::size_t> index_of(const std::string& name) const {
    for (std::size_t j = 0; j < before_.size(); ++j) {
      if (before_[j].name == name) return j;
    }
    return std::nullopt;
  }

  void read_primary() {
    const char* const key = BodyKeys::primary;
    if (!table_.has(key)) return;
    const auto primary = table_.text({.name = key, .type = OptionType::text});
    if (!primary) return;
    if (body_.orbit.empty() || index_ == 0) {
      complain(key, table_.found(key) + " without an orbit; allowed beside a, period or pericentre_distance");
      return;
    }
    if (*primary == BodyKeys::jacobi) return;
    if (*primary == BodyKeys::barycentre) {
      body_.primary = Primary::barycentre;
      return;
    }
    std::vector<std::string> allowed{BodyKeys::jacobi, BodyKeys::barycentre};
    for (const ListedBody& body : before_) allowed.push_back(body.name);
    const auto of = index_of(*primary);
    if (!of) {
      complain(key, "found \"" + *primary + "\", which no body before this one is called; allowed " + joined(allowed) +
                        suggestion(*primary, allowed));
    } else if (!(number_value(before_[*of].mass) > 0)) {
      complain(key, "found \"" + *primary + "\", whose mass is 0; allowed a body with a mass");
    } else {
      body_.primary = Primary::body;
      body_.of = *of;
    }
  }

  void complain_of_orbit() {
    for (const Complaint& complaint : complaints_about(orbit_of(body_.orbit))) {
      complain(complaint.key, complaint.message);
    }
    double mass = number_value(body_.mass);
    for (const ListedBody& body : before_) mass += number_value(body.mass);
    if (body_.primary == Primary::jacobi && !(mass > number_value(body_.mass))) {
      complain(BodyKeys::primary,
               "found an orbit about bodies whose masses are 0; allowed a body with a mass before it");
    }
  }

  TomlTable& table_;
  std::size_t index_;
  const std::vector<ListedBody>& before_;
  ListedBody body_;
  bool is_sound_ = true;
};

}  // namespace

void ScenarioReader::read_units(TomlTable& table) {
  table.know(BodyKeys::units);
  if (!table.has(BodyKeys::units)) return;
  TomlTable units = table.table(BodyKeys::units);
  if (!units.exists()) return;
  std::vector<std::string> names;
  for (const OptionInfo& key : unit_keys()) {
    if (const auto name = units.text(key)) names.push_back(*name);
  }
  units.finish();
  if (table.has(BodyKeys::constant)) {
    table.know(BodyKeys::constant);
    table.complain(BodyKeys::constant, std::string("found ") + BodyKeys::constant + " together with " +
                                           BodyKeys::units + ", which name G; allowed one of them");
  }
  if (names.size() != unit_keys().size()) return;
  scenario_.units = {names[0], names[1], names[2]};
  scenario_.request.parameters[BodyKeys::constant] = gravitational_constant_in(names[0], names[1], names[2]);
}

void ScenarioReader::read_body_list(TomlTable& table) {
  read_units(table);
  if (!table.has(BodyKeys::bodies)) {
    table.know(BodyKeys::bodies);
    return;
  }
  for (const char* other : {BodyKeys::masses, "initial"}) {
    table.know(other);
    if (table.has(other)) {
      table.complain(other, std::string("found ") + other + " together with bodies; allowed one of them");
    }
  }
  // Without bodies the other checks would complain of missing masses.
  scenario_.request.parameters[BodyKeys::masses] = "[1]";
  auto tables = table.tables(BodyKeys::bodies, 0);
  if (!tables) return;
  if (tables->empty()) {
    table.complain(BodyKeys::bodies, "found no body; allowed an array of tables, one for each body");
    return;
  }
  const std::size_t before = complaints_.size();
  BodyList& list = body_list_;
  for (std::size_t i = 0; i < tables->size(); ++i) {
    list.bodies.push_back(BodyReader((*tables)[i], i, list.bodies).read());
  }
  check_space(*tables);
  if (complaints_.size() == before) check_barycentre(*tables);
  OptionInfo constant = *find_option(n_body_keys(), BodyKeys::constant);
  if (table.has(BodyKeys::constant) && !table.has(BodyKeys::units)) {
    scenario_.request.parameters[BodyKeys::constant] = table.text(constant).value_or("1");
  }
  if (complaints_.size() != before) return;
  std::vector<std::string> masses;
  double total = 0;
  for (const ListedBody& body : list.bodies) {
    masses.push_back(body.mass);
    total += number_value(body.mass);
    scenario_.body_names.push_back(body.name);
  }
  if (!(total > 0)) {
    table.complain(BodyKeys::bodies, "found masses that are all 0; allowed at least one body with a mass");
    return;
  }
  Texts& parameters = scenario_.request.parameters;
  parameters[BodyKeys::masses] = "[" + joined(masses) + "]";
  if (parameters.contains(BodyKeys::constant)) list.gravitational_constant = parameters.at(BodyKeys::constant);
  if (!(number_value(list.gravitational_constant) > 0) &&
      std::any_of(list.bodies.begin(), list.bodies.end(), [](const ListedBody& body) { return !body.orbit.empty(); })) {
    table.complain(BodyKeys::constant, table.found(BodyKeys::constant) + " beside an orbit; allowed a positive number");
    return;
  }
  place_bodies(table, scenario_.request.arithmetic);
}

/// All vectors have as many numbers, and 2 only without an orbit in space.
void ScenarioReader::check_space(std::vector<TomlTable>& tables) {
  BodyList& list = body_list_;
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const std::size_t size = list.bodies[i].position.size();
    if (size == 0) continue;
    if (!first) first = i;
    const std::size_t wanted = list.bodies[*first].position.size();
    list.space = wanted;
    if (size == wanted) continue;
    tables[i].complain(BodyKeys::position, "found " + std::to_string(size) + " entries; allowed " +
                                               std::to_string(wanted) + ", as " + list.bodies[*first].name + " has");
  }
  for (std::size_t i = 0; list.space == 2 && i < tables.size(); ++i) {
    for (const char* key : {"inclination", "node"}) {
      if (!tables[i].has(key)) continue;
      tables[i].complain(key, std::string("found ") + key +
                                  " together with positions of 2 numbers; allowed in space, " + "with positions of 3");
    }
  }
}

/// About the barycentre are all massive bodies but the first, or none.
void ScenarioReader::check_barycentre(std::vector<TomlTable>& tables) {
  const BodyList& list = body_list_;
  std::string with;
  const auto is_massive = [&](std::size_t i) { return number_value(list.bodies[i].mass) > 0; };
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const ListedBody& body = list.bodies[i];
    if (is_massive(i) && body.primary == Primary::barycentre && with.empty()) with = body.name;
  }
  if (with.empty()) return;
  const std::string because = ", as " + with + " has it: all bodies with a mass but the first, or none";
  if (!is_massive(0)) {
    tables[0].complain(BodyKeys::mass, tables[0].found(BodyKeys::mass) +
                                           "; allowed a positive number, because the first body is placed so that the "
                                           "centre of mass is the origin");
  } else if (tables[0].has(BodyKeys::position)) {
    tables[0].complain(BodyKeys::position,
                       "found position of the first body beside primary = \"barycentre\"; allowed neither position nor "
                       "velocity, because it is placed so that the centre of mass is the origin");
  }
  for (std::size_t i = 1; i < tables.size(); ++i) {
    if (!is_massive(i) || list.bodies[i].primary == Primary::barycentre) continue;
    tables[i].complain(BodyKeys::primary, (tables[i].has(BodyKeys::primary) ? tables[i].found(BodyKeys::primary)
                                                                            : std::string("found no primary")) +
                                              "; allowed \"barycentre\"" + because);
  }
}

/// Refuses what a splitting into Kepler motions about the first body does not know.
void ScenarioReader::check_kepler_splitting(TomlTable& method) {
  const std::string& name = scenario_.request.method.name;
  const bool is_one = name == "wisdom-holman" || name == "saba";
  if (!is_one || scenario_.problem == nullptr || !complaints_.empty()) return;
  const std::string others = "kahan-li8, rkn8-s19, dop853";
  TomlTable problem = root_.table("problem");
  if (scenario_.request.walls) {
    problem.complain(wall_keys().walls.name, "found walls with " + name + "; allowed with " + others);
  }
  if (!takes_body_list(scenario_.problem->info)) return;
  const Parameters<double> parameters(scenario_.request.parameters);
  if (parameters["softening"] > 0) {
    problem.complain("softening", problem.found("softening") + " with " + name +
                                      ", whose bodies move on conics; allowed 0, or the methods " + others);
  }
  if (!(parameters[BodyKeys::constant] > 0)) {
    problem.complain(BodyKeys::constant, problem.found(BodyKeys::constant) + " with " + name +
                                             "; allowed a positive number, or the methods " + others);
  }
  const std::vector<double> masses = parameters.list(BodyKeys::masses);
  const auto heaviest = std::max_element(masses.begin(), masses.end());
  if (heaviest == masses.begin() || !(masses.front() < *heaviest)) return;
  const auto index = static_cast<std::size_t>(heaviest - masses.begin());
  const std::string body =
      index < scenario_.body_names.size() ? scenario_.body_names[index] : "body " + std::to_string(index + 1);
  method.complain(method_name_key().name, method.found(method_name_key().name) + " with " + body +
                                              " heavier than the first body; allowed the heaviest body first, or the "
                                              "methods " +
                                              others);
}

/// Refuses what does not know massless bodies: the forces on them follow from no term of H.
void ScenarioReader::check_massless(TomlTable& method, TomlTable& run) {
  if (scenario_.problem == nullptr || !takes_body_list(scenario_.problem->info) || !complaints_.empty()) return;
  const std::vector<double> masses = Parameters<double>(scenario_.request.parameters).list(BodyKeys::masses);
  const auto massless = std::count(masses.begin(), masses.end(), 0.0);
  if (massless == 0) return;
  TomlTable problem = root_.table("problem");
  if (massless == static_cast<std::ptrdiff_t>(masses.size())) {
    problem.complain(BodyKeys::masses, "found masses that are all 0; allowed at least one body with a mass");
    return;
  }
  const std::string beside = " beside bodies of mass 0; allowed ";
  if (has_method() && !describe(scenario_.request.method).explicit_step) {
    method.complain(method_name_key().name,
                    method.found(method_name_key().name) + beside +
                        "explicit methods such as stv4, dop853 and taylor, because implicit ones "
                        "solve the equations of one H for all bodies");
  }
  if (scenario_.request.arithmetic == "lattice") {
    run.complain(run_keys().arithmetic.name, run.found(run_keys().arithmetic.name) + beside +
                                                 "the other arithmetics, because the lattice adds each force to two "
                                                 "bodies with opposite signs");
  }
  for (const OptionInfo* key : {&run_keys().lyapunov, &run_keys().eigenvalues}) {
    if (key == &run_keys().lyapunov ? scenario_.lyapunov == 0 : !scenario_.eigenvalues) continue;
    run.complain(key->name, run.found(key->name) + beside +
                                "bodies with masses, because the derivative of a step is that of one H for all bodies");
  }
  if (scenario_.request.walls) {
    problem.complain(wall_keys().walls.name,
                     "found walls" + beside + "bodies with masses, because the energy at a wall is a part of H");
  }
}

/// Two bodies that attract each other are at different points, unless the force is softened.
void ScenarioReader::check_places(TomlTable& table) {
  const std::vector<ListedBody>& bodies = body_list_.bodies;
  if (table.has("softening")) return;
  const std::vector<std::string>& q = scenario_.request.start.q;
  const auto space = static_cast<std::ptrdiff_t>(body_list_.space);
  std::vector<bool> is_massive;
  for (const ListedBody& body : bodies) is_massive.push_back(number_value(body.mass) > 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const auto a = q.begin() + static_cast<std::ptrdiff_t>(i) * space;
      const auto b = q.begin() + static_cast<std::ptrdiff_t>(j) * space;
      if (!(is_massive[i] || is_massive[j]) || !std::equal(a, a + space, b)) continue;
      table.complain(BodyKeys::bodies, "found " + bodies[i].name + " and " + bodies[j].name +
                                           " at one point; allowed different points, or softening > 0");
      return;
    }
  }
}

/// Makes the start in the digits of an arithmetic.
void ScenarioReader::place_bodies(TomlTable& table, const std::string& arithmetic) {
  if (body_list_.bodies.empty()) return;
  try {
    const StartSpec placed = start_of(body_list_, arithmetic);
    scenario_.request.start.q = placed.q;
    scenario_.request.start.p = placed.p;
    check_places(table);
  } catch (const Error& error) {
    table.complain(BodyKeys::bodies, "found an orbit of " + std::string(error.what()) +
                                         " whose position or velocity is not finite; allowed numbers between about "
                                         "1e-100 and 1e100");
  }
}

}  // namespace hamflow
