#include "socket_entry.hpp"

#include <cmath>
#include <limits>

#include "engine/erased.hpp"
#include "methods/recipes.hpp"
#include "socket_simulation.hpp"

namespace hamflow {

namespace {

using Keys = SocketKeys;
constexpr std::size_t space_dimension = 3;

Cell cell_of(const Parameters<double>& given) {
  const std::vector<double>& numbers = given.list(Keys::cell);
  Cell cell{};
  for (std::size_t i = 0; i < numbers.size(); ++i) cell.at(numbers.size() == space_dimension ? 4 * i : i) = numbers[i];
  return cell;
}

double volume(const Cell& c) {
  return c[0] * (c[4] * c[8] - c[5] * c[7]) + c[1] * (c[5] * c[6] - c[3] * c[8]) + c[2] * (c[3] * c[7] - c[4] * c[6]);
}

std::string refused_size(const Texts& texts, std::size_t size) {
  const std::size_t masses = Parameters<double>(texts).list(Keys::masses).size();
  if (size == 0 || size % space_dimension != 0) return "3 numbers for each atom";
  if (masses == 1 || masses * space_dimension == size) return {};
  return std::to_string(masses * space_dimension) + " numbers for the " + std::to_string(masses) + " atoms of masses";
}

std::pair<std::string, std::string> refused_parameters(const Texts& texts) {
  const Parameters<double> given(texts);
  const std::size_t size = given.list(Keys::cell).size();
  if (size != space_dimension && size != space_dimension * space_dimension) {
    return {Keys::cell, "allowed 3 edges, or the 9 components of three vectors"};
  }
  if (!(volume(cell_of(given)) > 0)) return {Keys::cell, "allowed three vectors that span a positive volume"};
  return {};
}

Vector<double, dynamic> vector_of(const std::vector<double>& x) {
  Vector<double, dynamic> v(x.size());
  std::copy(x.begin(), x.end(), v.begin());
  return v;
}

SocketProblem problem_of(const std::shared_ptr<ForceServer>& server, const Parameters<double>& given, std::size_t size,
                         std::shared_ptr<ClientForces>* client = nullptr) {
  const double length = given[Keys::length_unit];
  Cell cell = cell_of(given);
  for (double& x : cell) x *= length;
  auto forces = std::make_shared<ClientForces>(server, cell, length, given[Keys::energy_unit], given[Keys::timeout]);
  if (client != nullptr) *client = forces;
  return {given.list(Keys::masses), size, std::move(forces)};
}

Frame start_of(const Request& request) {
  const StartSpec& spec = request.start;
  if (!spec.energy.empty()) {
    throw Error("found energy = " + spec.energy + "; allowed numbers for all components, because a start by energy " +
                "would need forces before the client has connected");
  }
  const SocketProblem problem = problem_of(nullptr, Parameters<double>(request.parameters), spec.q.size());
  Frame frame;
  for (const std::string& text : spec.q) frame.q.push_back(evaluate_number<double>(text));
  for (const std::string& text : spec.v.empty() ? spec.p : spec.v) frame.p.push_back(evaluate_number<double>(text));
  for (std::size_t i = 0; !spec.v.empty() && i < frame.p.size(); ++i) frame.p[i] *= problem.mass(i);
  return frame;
}

/// @throws ClientError if the client gives no forces at the start   @throws Error in an arithmetic beyond double
std::unique_ptr<Simulation> simulate(const std::shared_ptr<ForceServer>& server, const Request& request,
                                     const Parameters<double>& given, const std::vector<double>& q,
                                     const std::vector<double>& p, double h) {
  if (digits_beyond_double(request.arithmetic) > 0) {
    throw Error("found arithmetic = \"" + request.arithmetic +
                "\"; allowed double, compensated or lattice, because a client sends its forces in double");
  }
  server->restart();
  std::shared_ptr<ClientForces> client;
  const SocketProblem problem = problem_of(server, given, q.size(), &client);
  const ErasedFunctions<double> functions{Capability::separable | Capability::quadratic_kinetic, q.size(),
                                          functions_of<double>(problem), nullptr, nullptr};
  Request asked = request;
  asked.record = false;
  try {
    return keeping_good_states(simulate_erased<double>({functions, vector_of(q), vector_of(p), h}, asked),
                               std::move(client));
  } catch (const ForceServer::Stopped&) {
    throw ClientError("stopped before the client of problem.address gave the first forces");
  }
}

void add_functions(ProblemEntry& e, const std::string& address) {
  const std::shared_ptr<ForceServer> server = address.empty() ? nullptr : ForceServer::at(address);
  e.refused_size = refused_size;
  e.refused_parameters = refused_parameters;
  e.refused_start = [](const Texts&, const std::vector<double>&) { return StartRefusal(); };
  e.accepts = [usable = server != nullptr](const MethodSpec& method) {
    if (!usable || method.name == "taylor") return false;  // a series needs all derivatives
    return visit_method(method, [](const auto& recipe) { return is_accepted<SocketProblem>(recipe); });
  };
  e.simulate = [](const Request&) { return std::unique_ptr<Simulation>(); };
  e.simulate_erased = [server](const Request& request) {
    const Frame start = start_of(request);
    return simulate(server, request, Parameters<double>(request.parameters), start.q, start.p,
                    evaluate_number<double>(request.dt));
  };
  e.simulate_member = [server](const Request& request, const Parameters<double>& parameters,
                               const std::vector<double>& q, const std::vector<double>& p,
                               double h) { return simulate(server, request, parameters, q, p, h); };
  e.step_map = [](const Request&, std::size_t) { return std::unique_ptr<StepMap>(); };
  e.derived = [](const Texts& parameters, const StartSpec&) { return parameters; };
  e.conditions = [](const Texts&, const StartSpec&) { return std::vector<Condition>(); };
  // There is no e.energy: outside a run nobody may expect that a client is there.
  e.gradient = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
    Vector<double, dynamic> v(p.size());
    problem_of(nullptr, Parameters<double>(parameters), q.size()).velocity(vector_of(p), v);
    return EnergyGradient{std::vector<double>(q.size(), std::numeric_limits<double>::quiet_NaN()),
                          {v.begin(), v.end()}};
  };
  e.regular = [](const Texts&, const std::vector<double>&, const std::vector<double>&) { return true; };
  e.invariant_sizes = [](const Texts&, std::size_t) { return std::vector<std::size_t>(); };
  e.start = start_of;
  e.total_mass = [](const Texts& parameters, std::size_t size) {
    const SocketProblem problem = problem_of(nullptr, Parameters<double>(parameters), size);
    double sum = 0;
    for (std::size_t i = 0; i < size; i += space_dimension) sum += problem.mass(i);
    return sum;
  };
}

ProblemEntry entry_of(const std::string& address) {
  if (!address.empty()) {
    if (const std::string why_not = refused_address(address); !why_not.empty()) {
      throw Error(std::string(Keys::address) + ": " + why_not);
    }
  }
  ProblemEntry e;
  ProblemInfo& info = e.info;
  info.name = Keys::problem;
  if (!address.empty()) info.variant = {{Keys::address, address}};
  info.formula = "H = sum |p_i|^2/(2 m_i) + V(q), V from another program";
  info.reference = "Ceriotti2014";
  info.coordinates = {"x1", "y1", "z1", "x2", "..."};
  info.keys = socket_options();
  info.parameters = {socket_options().begin() + 1, socket_options().end()};
  info.region = {.parameters = {{Keys::cell, "[20, 20, 20]"}},
                 .centre = {-1, 0, 0, 1, 0, 0, 0, 0.1, 0, 0, -0.1, 0},
                 .spread = 0.03,
                 .step = 0.011,
                 .time = 1.3};
  info.example.keys = {{Keys::address, ""}, {Keys::masses, ""}, {Keys::cell, ""}};
  add_functions(e, address);
  return e;
}

}  // namespace

const std::vector<OptionInfo>& socket_options() {
  static const std::vector<OptionInfo> all{
      {.name = Keys::address,
       .meaning = "where the client connects: unix:NAME, the Unix socket /tmp/ipi_NAME, or 127.0.0.1:PORT",
       .type = OptionType::text,
       .required = true,
       .example = "unix:hamflow",
       .free_on_resume = true},
      {.name = Keys::masses,
       .default_value = "1",
       .meaning = "mass of all atoms, or a mass for each; the unit of time follows from those of mass, length and "
                  "energy",
       .range = Range::positive,
       .type = OptionType::number_or_list},
      {.name = Keys::cell,
       .meaning = "3 edges of the periodic cell, or its three vectors, one after the other, in length units of the "
                  "scenario; the client uses it, hamflow does not",
       .type = OptionType::list,
       .required = true,
       .example = "[20, 20, 20]"},
      {.name = Keys::length_unit,
       .default_value = "1",
       .meaning = "length unit of the scenario in bohr, the unit of the protocol",
       .range = Range::positive},
      {.name = Keys::energy_unit,
       .default_value = "1",
       .meaning = "energy unit of the scenario in hartree, the unit of the protocol",
       .range = Range::positive},
      {.name = Keys::timeout,
       .default_value = "60",
       .meaning = "how long to wait for the client to connect, and for each of its answers",
       .range = Range::positive,
       .unit = "seconds",
       .free_on_resume = true}};
  return all;
}

std::shared_ptr<const ProblemEntry> socket_problem(const std::map<std::string, std::string>& choices) {
  const auto address = choices.find(Keys::address);
  return std::make_shared<const ProblemEntry>(entry_of(address == choices.end() ? "" : address->second));
}

}  // namespace hamflow
