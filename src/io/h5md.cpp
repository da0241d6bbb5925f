#include <pwd.h>
#include <unistd.h>

#include <algorithm>

#include "h5md_groups.hpp"
#include "hdf5_text.hpp"
#include "stored_column.hpp"

namespace hamflow {

namespace {

void write_integers(hid_t object, const char* name, const std::vector<int>& numbers) {
  const hsize_t size = numbers.size();
  const Hdf5Handle space(numbers.size() == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), H5Sclose,
                         "make a data space");
  const Hdf5Handle attribute(H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                             std::string("create attribute ") + name);
  check_hdf5(H5Awrite(attribute, H5T_NATIVE_INT, numbers.data()), std::string("write attribute ") + name);
}

void link(hid_t file, const std::string& from, const std::string& to) {
  check_hdf5(H5Lcreate_hard(file, from.c_str(), file, to.c_str(), H5P_DEFAULT, H5P_DEFAULT), "link " + to);
}

/// Writes a dataset of one row.
void write_row(hid_t file, const std::string& path, ColumnInfo info, const void* values, std::size_t of_each = 0) {
  StoredColumn(file, path, info, 1, of_each).write(values, 1);
}

/// Writes an element with one sample, the start. Like datasets of many rows, its datasets have checksums.
void write_once(hid_t file, const std::string& name, const std::vector<double>& numbers, std::size_t of_each,
                ColumnInfo info) {
  (void)make_group(file, name);
  constexpr std::int64_t step = 0;
  constexpr double time = 0;
  write_row(file, name + "/step", {.type = ValueType::integer, .meaning = "steps since the start"}, &step);
  write_row(file, name + "/time", {.meaning = "time"}, &time);
  info.width = numbers.size();
  info.scalar = false;
  write_row(file, name + "/value", info, numbers.data(), of_each);
}

void write_box(hid_t file, const std::string& particles, const H5mdParticles& of) {
  const Hdf5Handle box = make_group(file, particles + "/box");
  write_integers(box, "dimension", {static_cast<int>(of.space)});
  write_attribute(box, "boundary", of.boundary);
  if (!of.edges.empty()) (void)make_group(file, particles + "/box/edges");
}

}  // namespace

bool H5mdParticles::unit_masses() const {
  return std::all_of(masses.begin(), masses.end(), [](double m) { return m == 1; });
}

void write_h5md_groups(hid_t file, const RunDescription& run) {
  const H5mdParticles& of = run.particles;
  const Hdf5Handle h5md = make_group(file, "h5md");
  write_integers(h5md, "version", {1, 1});
  write_attribute(make_group(file, "h5md/author"), "name", of.author.empty() ? std::string("unknown") : of.author);
  const Hdf5Handle creator = make_group(file, "h5md/creator");
  write_attribute(creator, "name", std::string("hamflow"));
  write_attribute(creator, "version", run.version);
  (void)make_group(file, "particles");
  (void)make_group(file, "particles/all");
  write_box(file, "particles/all", of);
  for (const char* element : {"position", "momentum", "velocity"})
    (void)make_group(file, std::string("particles/all/") + element);
  write_once(file, "particles/all/mass", of.masses, 0, {.meaning = "mass of each particle"});
  (void)make_group(file, "observables/energy");
  for (const InvariantColumn& each : run.invariants) (void)make_group(file, "observables/" + each.name);
  for (const InvariantColumn& each : run.observables) (void)make_group(file, "observables/" + each.name);
  if (of.start_q.empty()) return;
  (void)make_group(file, "particles/start");
  write_box(file, "particles/start", of);
  write_once(file, "particles/start/position", of.start_q, of.space,
             {.meaning = "coordinates at the start", .unit = run.units.q});
  write_once(file, "particles/start/momentum", of.start_p, of.space,
             {.meaning = "momenta at the start", .unit = run.units.p});
  if (of.edges.empty()) return;
  write_row(file, "particles/start/box/edges/value",
            {.width = of.space, .scalar = false, .meaning = H5mdNames::edges_meaning}, of.edges.data());
  for (const char* part : {"/step", "/time"}) {
    link(file, std::string("/particles/start/position") + part, std::string("particles/start/box/edges") + part);
  }
}

void link_h5md_elements(hid_t file, const RunDescription& run) {
  const auto timed = [&](const std::string& element) {
    link(file, "/step", element + "/step");
    if (run.particles.time_grows) link(file, "/t", element + "/time");
  };
  for (const char* element : {"position", "momentum", "velocity"}) timed(std::string("particles/all/") + element);
  if (!run.particles.edges.empty()) timed("particles/all/box/edges");
  if (run.particles.unit_masses()) link(file, H5mdNames::momentum, H5mdNames::velocity);
  link(file, "/energy", "observables/energy/value");
  timed("observables/energy");
  for (const InvariantColumn& each : run.invariants) {
    link(file, "/invariants/" + each.name, "observables/" + each.name + "/value");
    timed("observables/" + each.name);
  }
  for (const InvariantColumn& each : run.observables) timed("observables/" + each.name);
}

std::string author_name() {
  const passwd* const user = getpwuid(geteuid());
  if (user == nullptr) return {};
  const std::string real_name = user->pw_gecos != nullptr ? user->pw_gecos : "";
  const std::string first = real_name.substr(0, real_name.find(','));
  return first.empty() ? std::string(user->pw_name) : first;
}

}  // namespace hamflow
