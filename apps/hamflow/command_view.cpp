// hamflow view: writes the laboratory, one HTML file, with a scenario, a run or a sweep in it, and opens it.
#include <hdf5.h>
#include <spawn.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/workflow/convert.hpp"
#include "hamflow/workflow/open_run.hpp"
#include "hdf5_read.hpp"

extern char** environ;

namespace hamflow::app {

namespace {

namespace fs = std::filesystem;
constexpr const char* place = "<!--inlined-->";                    // in laboratory.html, where the data go
constexpr std::size_t most_numbers = 15'000'000 / sizeof(double);  // 20 MB as base64

/// Reads the laboratory that is installed with this command, or built beside it.
std::string laboratory() {
  std::error_code none;
  const fs::path folder = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& file : {folder / "../share/hamflow/laboratory.html", folder / "../web/laboratory.html"}) {
    std::ifstream in(file, std::ios::binary);
    if (!in) continue;
    const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (page.find(place) != std::string::npos) return page;
  }
  throw FileError(
      "the laboratory is neither installed in share/hamflow nor built; to build it, run ./dev web in the sources of "
      "hamflow");
}

std::string base64(const std::vector<double>& numbers) {
  constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes(numbers.size() * sizeof(double));
  if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  std::string text;
  text.reserve(bytes.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// Named columns of numbers, of equal length.
struct NumberColumns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  void add(std::string name, std::vector<double> column) {
    names.push_back(std::move(name));
    columns.push_back(std::move(column));
  }
};

/// What the page finds at `place` (web/src/state/inlined.ts). Leaves out rows if there are too many numbers.
nlohmann::json inlined(const char* kind, const std::string& name, const std::string& toml, const NumberColumns& all) {
  const std::size_t rows = all.columns.empty() ? 0 : all.columns.front().size();
  const std::size_t numbers = rows * all.columns.size();
  const std::size_t every = std::max<std::size_t>(1, (numbers + most_numbers - 1) / most_numbers);
  std::vector<double> kept;
  for (std::size_t row = 0; row < rows; row += every) {
    for (const std::vector<double>& column : all.columns) kept.push_back(column[row]);
  }
  const std::string note = every == 1 ? "" : "one of every " + std::to_string(every) + " is in this file";
  return {{"kind", kind},         {"name", name},         {"toml", toml},
          {"columns", all.names}, {"rows", base64(kept)}, {"note", note}};
}

nlohmann::json inlined_run(const fs::path& file, const std::string& name) {
  const OpenedRun run = open_run(file);
  const Scenario& scenario = run.scenario;
  const Table& samples = run.tables.samples;
  const StateNames names = state_names(*scenario.problem, scenario.request.parameters, scenario.start_q.size());
  NumberColumns all;
  all.add("t", samples["t"].part(0));
  for (std::size_t i = 0; i < names.q.size(); ++i) all.add(names.q[i], samples["q"].part(i));
  for (std::size_t i = 0; i < names.p.size(); ++i) all.add(names.p[i], samples["p"].part(i));
  std::vector<double> error = samples["energy"].part(0);
  const double first = error.empty() ? 0 : error.front();
  for (double& energy : error) energy -= first;
  all.add("energy error", std::move(error));
  for (const Column& column : samples.columns()) {
    const std::string& path = column.name();
    const bool is_measure = path.starts_with("invariants/") || path.starts_with("observables/");
    if (is_measure && column.info().width == 1) all.add(path.substr(path.find('/') + 1), column.part(0));
  }
  return inlined("run", name, scenario.text, all);
}

/// Adds the columns of numbers in a group of sweep.h5 that have a row for each member, with their paths.
void add_columns(hid_t group, const std::string& path, std::size_t members, NumberColumns& all) {
  for (const std::string& name : names_in(group)) {
    const Hdf5Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose, "open " + path + name);
    if (H5Iget_type(object) == H5I_GROUP) add_columns(object, path + name + "/", members, all);
    if (H5Iget_type(object) != H5I_DATASET) continue;
    const StoredData data = StoredData::dataset(group, name);
    if (data.kind() != StoredData::Kind::numbers || data.shape().empty() || data.rows() != members) continue;
    const std::vector<double> numbers = data.numbers();
    for (std::size_t k = 0; k < data.width(); ++k) {
      std::vector<double> column;
      for (std::size_t at = k; at < numbers.size(); at += data.width()) column.push_back(numbers[at]);
      all.add(path + name + (data.shape().size() == 1 ? "" : "[" + std::to_string(k) + "]"), std::move(column));
    }
  }
}

nlohmann::json inlined_sweep(const fs::path& path, const std::string& name) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  const std::size_t members = StoredData::dataset(file, "member/status").rows();
  NumberColumns all;
  for (const char* group : {"varied", "energy", "final", "invariants", "observables", "member"}) {  // in this order
    if (!has_object(file, group)) continue;
    const Hdf5Handle opened(H5Oopen(file, group, H5P_DEFAULT), H5Oclose, std::string("open ") + group);
    add_columns(opened, std::string(group) + "/", members, all);
  }
  return inlined("sweep", name, StoredData::dataset(file, "scenario").text(), all);
}

nlohmann::json inlined_of(const std::string& input) {
  fs::path path = input;
  if (!path.has_filename()) path = path.parent_path();  // "kepler.run/"
  const std::string name = path.filename().string();
  if (path.filename() == "sweep.h5") return inlined_sweep(path, name);
  if (fs::is_regular_file(path / "sweep.h5")) return inlined_sweep(path / "sweep.h5", name);
  if (is_run(path)) return inlined_run(path, name);
  return inlined("scenario", name, accepted(read_scenario(path, {})).text, {});
}

void open_in_browser(const std::string& file) {
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr && *std::getenv(name) != '\0'; };
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY")) return;  // xdg-open would open a browser in the terminal
  std::string program = "xdg-open";
  std::string argument = file;
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  (void)posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ);  // the path is printed anyway
}

}  // namespace

int view_command(const ViewOptions& options) {
  return guarded(false, [&] {
    std::string page = laboratory();
    std::string file = options.file;
    if (file.empty()) {
      const fs::path input = options.input;
      file = input.empty() ? "laboratory.html"
                           : (input.has_filename() ? input : input.parent_path()).stem().string() + ".html";
    }
    require_folder_of(file);
    if (!options.input.empty()) {
      const nlohmann::json data = inlined_of(options.input);
      if (const std::string note = data["note"]; !note.empty()) print_notes({note}, false);
      std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
      // A script element ends at "</script", wherever that stands.
      for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) text.replace(at, 1, "\\u003c");
      page.replace(page.find(place), std::strlen(place),
                   "<script type=\"application/json\" id=\"inlined\">" + text + "</script>");
    }
    write_file(file, page);
    std::cout << file << '\n';
    if (options.browser) open_in_browser(fs::absolute(file).string());
    return exit_done;
  });
}

}  // namespace hamflow::app
