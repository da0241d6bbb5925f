// libFuzzer on the files that hamflow reads again. An input is a list of changes of a file that was just written: its
// HDF5 objects and attributes get other types, ranks, sizes and values, or the bytes of a checkpoint change, under a
// checksum that fits. What reads the file either throws one of hamflow's exceptions, or goes on. ./dev fuzz builds and
// runs it.
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "figure_data.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/convert.hpp"
#include "hamflow/workflow/open_run.hpp"
#include "hamflow/workflow/reverse.hpp"
#include "hamflow/workflow/run.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "hdf5_text.hpp"
#include "scenario/gas_start.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hamflow;

constexpr const char* kepler = R"([problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "cg"
diagnostics = true
[run]
dt = 0.1
steps = 6
record_every = 2
checkpoint_every = 3
section = { coordinate = "y" }
events = [{ name = "right", expression = "x - 0.9" }]
[output]
observables = { r2 = "x^2 + y^2" }
)";
constexpr const char* beyond = R"([problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 4
arithmetic = "double-double"
)";
constexpr const char* walls = R"([problem]
name = "henon-heiles"
initial = { q = [0.0, 0.1], p = [0.3, 0.1] }
walls = [{ coordinate = "q1", min = -0.05, max = 0.05 }]
[method]
name = "verlet"
[run]
dt = 0.1
steps = 6
lyapunov = 1
)";
constexpr const char* gas = R"([problem]
name = "gas"
particles_per_side = 2
container = { kind = "box", size = [4, 4] }
[method]
name = "verlet"
[run]
dt = 0.001
steps = 4
[output]
observables = { first = "q1" }
)";
const std::vector<std::string> varied{"run.dt=0.1,0.05"};

/// The bytes of an input; zeros behind its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  bool is_over() const { return at_ >= size_; }
  std::size_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : (byte() + 256 * (limit > 256 ? byte() : 0)) % limit; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

struct Place {
  std::string object;
  std::string attribute;  // empty: the dataset itself
};

struct Template {
  fs::path folder;
  std::string file;  // that is changed
  const char* scenario;
  std::vector<Place> places;  // of an HDF5 file
};

std::vector<std::byte> bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Scenario scenario_of(const char* text, const std::vector<std::string>& sets = {}) {
  return accepted(read_scenario_text(text, "s.toml", sets));
}

std::vector<Place> places_in(const fs::path& path) {
  const Hdf5Handle file = open_to_read(path);
  std::vector<Place> places;
  const auto note = [](hid_t from, const char* name, const H5O_info_t* info, void* all) -> herr_t {
    auto& list = *static_cast<std::vector<Place>*>(all);
    if (info->type == H5O_TYPE_DATASET) list.push_back({name, ""});
    const Hdf5Handle object(H5Oopen(from, name, H5P_DEFAULT), H5Oclose, "open");
    for (const std::string& attribute : attribute_names(object)) list.push_back({name, attribute});
    return 0;
  };
  check_hdf5(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, note, &places, H5O_INFO_BASIC), "list the objects");
  return places;
}

const fs::path& work_folder() {
  static const fs::path folder = [] {
    const fs::path base = fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
    fs::path made = base / ("hamflow_fuzz_" + std::to_string(getpid()));
    fs::remove_all(made);
    fs::create_directories(made);
    std::atexit([] { fs::remove_all(work_folder()); });
    return made;
  }();
  return folder;
}

const std::vector<Template>& templates() {
  static const std::vector<Template> all = [] {
    silence_hdf5();
    std::vector<Template> list;
    const auto add = [&](const std::string& name, const char* file, const char* scenario) {
      Template one{work_folder() / name, file, scenario, {}};
      if (one.file.ends_with(".h5")) one.places = places_in(one.folder / file);
      list.push_back(std::move(one));
    };
    for (const auto& [name, text] : {std::pair{"kepler", kepler}, {"beyond", beyond}, {"walls", walls}, {"gas", gas}}) {
      (void)run(scenario_of(text), {.folder = work_folder() / name});
      add(name, "run.h5", text);
      add(name, "checkpoint.bin", text);
    }
    (void)reverse_scenario(scenario_of(beyond), {.folder = work_folder() / "back"});
    add("back", "reverse.h5", beyond);
    add("back", "reversal.bin", beyond);
    {
      ScenarioSweep sweep({.text = kepler, .name = "s.toml", .varied = varied, .threads = 1});
      (void)sweep.keep_in(work_folder() / "many", Existing::replace);
      (void)sweep.run();
    }
    add("many", "members.bin", kepler);
    return list;
  }();
  return all;
}

Hdf5Handle some_type(Input& input) {
  const auto copy = [](hid_t type) { return Hdf5Handle(H5Tcopy(type), H5Tclose, "copy a type"); };
  switch (input.below(10)) {
    case 0:
      return copy(H5T_IEEE_F64LE);
    case 1:
      return copy(H5T_STD_I8LE);
    case 2:
      return copy(H5T_IEEE_F32BE);
    case 3:
      return copy(H5T_STD_U64BE);
    case 4:
      return text_type(input.below(200) + 1);
    case 5: {
      Hdf5Handle type = copy(H5T_C_S1);
      H5Tset_size(type, H5T_VARIABLE);
      return type;
    }
    case 6: {
      Hdf5Handle type(H5Tcreate(H5T_COMPOUND, 16), H5Tclose, "make a type");
      H5Tinsert(type, "a", 0, H5T_IEEE_F64LE);
      H5Tinsert(type, "b", 8, H5T_STD_I32LE);
      return type;
    }
    case 7:
      return {H5Tvlen_create(H5T_IEEE_F64LE), H5Tclose, "make a type"};
    case 8:
      return copy(H5T_STD_REF_OBJ);
    default:
      return {H5Tcreate(H5T_OPAQUE, input.below(40) + 1), H5Tclose, "make a type"};
  }
}

/// A data space, and the chunks that a dataset of it needs; none where it is small.
Hdf5Handle some_space(Input& input, std::vector<hsize_t>& chunk) {
  constexpr hsize_t sizes[] = {0, 1, 2, 3, 4, 5, 7, 4000, hsize_t{1} << 33, hsize_t{1} << 60};
  const std::size_t rank = input.below(7);
  if (rank == 6) return {H5Screate(H5S_NULL), H5Sclose, "make a data space"};
  if (rank == 0) return {H5Screate(H5S_SCALAR), H5Sclose, "make a data space"};
  std::vector<hsize_t> size;
  hsize_t values = 1;
  for (std::size_t k = 0; k < rank; ++k) {
    size.push_back(sizes[input.below(std::size(sizes))]);
    values = std::min<hsize_t>(values * std::min<hsize_t>(size.back(), 1 << 20), 1 << 20);
  }
  const bool is_small = values <= 20000;
  if (!is_small) chunk.assign(rank, 1);
  const std::vector<hsize_t> most(rank, H5S_UNLIMITED);
  return {H5Screate_simple(static_cast<int>(rank), size.data(), is_small ? nullptr : most.data()), H5Sclose,
          "make a data space"};
}

/// Which HDF5 may refuse.
void replace_dataset(hid_t file, const std::string& path, Input& input) {
  const Hdf5Handle type = some_type(input);
  std::vector<hsize_t> chunk;
  const Hdf5Handle space = some_space(input, chunk);
  const Hdf5Handle plist(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list");
  if (!chunk.empty()) H5Pset_chunk(plist, static_cast<int>(chunk.size()), chunk.data());
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  const hid_t made = H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, plist, H5P_DEFAULT);
  if (made >= 0) H5Dclose(made);
}

void replace_attribute(hid_t object, const std::string& name, Input& input) {
  const Hdf5Handle type = some_type(input);
  std::vector<hsize_t> chunk;
  const Hdf5Handle space = some_space(input, chunk);
  H5Adelete(object, name.c_str());
  const hid_t made = chunk.empty() ? H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT) : -1;
  if (made < 0) return;
  const hssize_t points = std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0);
  const std::vector<char> values(static_cast<std::size_t>(points) * H5Tget_size(type), 0);
  if (!values.empty() && H5Tdetect_class(type, H5T_VLEN) == 0) H5Awrite(made, type, values.data());
  H5Aclose(made);
}

void change_values(hid_t file, const std::string& path, Input& input) {
  const hid_t data = H5Dopen2(file, path.c_str(), H5P_DEFAULT);
  if (data < 0) return;
  const Hdf5Handle dataset(data, H5Dclose, "open");
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose, "type");
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "space");
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  if (points <= 0 || points > 20000 || H5Tdetect_class(type, H5T_VLEN) != 0 || H5Tis_variable_str(type) != 0) return;
  if (H5Tdetect_class(type, H5T_REFERENCE) != 0) return;
  std::vector<char> values(static_cast<std::size_t>(points) * H5Tget_size(type));
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return;
  for (std::size_t count = input.below(8) + 1; count > 0; --count) {
    values[input.below(values.size())] = static_cast<char>(input.byte());
  }
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  if (path != "scenario") return;
  const std::string text(values.data(), values.size());
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  write_text_dataset(file, path, text);  // with the hash that it has then
}

void change_object(hid_t file, const Template& of, Input& input) {
  const Place& place = of.places[input.below(of.places.size())];
  const Place& other = of.places[input.below(of.places.size())];
  const char* const path = place.object.c_str();
  if (H5Lexists(file, path, H5P_DEFAULT) <= 0 && place.object != ".") return;
  if (!place.attribute.empty()) {
    const hid_t object = H5Oopen(file, path, H5P_DEFAULT);
    if (object < 0) return;
    replace_attribute(object, place.attribute, input);
    H5Oclose(object);
    return;
  }
  switch (input.below(8)) {
    case 0:
      H5Ldelete(file, path, H5P_DEFAULT);
      return;
    case 1:
    case 2:
      return replace_dataset(file, place.object, input);
    case 3:
      if (other.object == "." || H5Lmove(file, path, file, "moved", H5P_DEFAULT, H5P_DEFAULT) < 0) return;
      H5Lmove(file, other.object.c_str(), file, path, H5P_DEFAULT, H5P_DEFAULT);
      H5Lmove(file, "moved", file, other.object.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      return;
    case 4:
      H5Ldelete(file, path, H5P_DEFAULT);
      H5Lcreate_soft(("/" + other.object).c_str(), file, path, H5P_DEFAULT, H5P_DEFAULT);
      return;
    case 5: {
      H5Ldelete(file, path, H5P_DEFAULT);
      const bool is_circle = input.below(2) == 0;
      if (is_circle) {
        H5Lcreate_hard(file, "/", file, path, H5P_DEFAULT, H5P_DEFAULT);
        return;
      }
      const hid_t group = H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      if (group >= 0) H5Gclose(group);
      return;
    }
    case 6: {
      const hid_t data = H5Dopen2(file, path, H5P_DEFAULT);
      if (data < 0) return;
      const hsize_t size[8] = {input.below(12), input.below(5), input.below(3), 1, 1, 1, 1, 1};
      H5Dset_extent(data, size);
      H5Dclose(data);
      return;
    }
    default:
      return change_values(file, place.object, input);
  }
}

void change_bytes(std::vector<std::byte>& bytes, Input& input) {
  constexpr std::uint64_t words[] = {
      0, 1, 2, 3, 1ULL << 20, 1ULL << 40, 1ULL << 63, ~0ULL, 0x7ff8000000000000, 0xffefffffffffffff};
  if (bytes.empty()) return;
  const std::size_t at = input.below(bytes.size());
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  switch (input.below(4)) {
    case 0:
      bytes[at] = static_cast<std::byte>(input.byte());
      return;
    case 1:
      if (bytes.size() - at >= 8) std::memcpy(&bytes[at], &words[input.below(std::size(words))], 8);
      return;
    case 2:
      bytes.erase(place, place + static_cast<std::ptrdiff_t>(std::min(bytes.size() - at, input.below(64) + 1)));
      return;
    default:
      bytes.insert(place, input.below(16) + 1, static_cast<std::byte>(input.byte()));
  }
}

void add_word(std::vector<std::byte>& bytes, std::uint64_t word) {
  const auto some = std::as_bytes(std::span(&word, 1));
  bytes.insert(bytes.end(), some.begin(), some.end());
}

/// Behind two words of a head the content, then its checksum.
std::vector<std::byte> changed_checkpoint(const std::vector<std::byte>& whole, Input& input) {
  std::vector<std::byte> content(whole.begin() + 16, whole.end() - 8);
  while (!input.is_over()) change_bytes(content, input);
  std::vector<std::byte> all(whole.begin(), whole.begin() + 16);
  all.insert(all.end(), content.begin(), content.end());
  add_word(all, fnv1a(all));
  return all;
}

/// Behind two words of a head parts, each its length, its bytes and the hash of both.
std::vector<std::byte> changed_journal(const std::vector<std::byte>& whole, Input& input) {
  std::vector<std::vector<std::byte>> parts;
  for (std::size_t at = 16; at + 16 <= whole.size();) {
    std::uint64_t size = 0;
    std::memcpy(&size, &whole[at], sizeof size);
    const auto begin = whole.begin() + static_cast<std::ptrdiff_t>(at + 8);
    parts.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(size));
    at += 16 + size;
  }
  while (!input.is_over()) change_bytes(parts[input.below(parts.size())], input);
  std::vector<std::byte> all(whole.begin(), whole.begin() + 16);
  for (const auto& part : parts) {
    std::vector<std::byte> one;
    add_word(one, part.size());
    one.insert(one.end(), part.begin(), part.end());
    add_word(one, fnv1a(one));
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

template <class Read>
void attempt(const Read& read) {
  try {
    read();
  } catch (const Error&) {  // a Rejection is one
  } catch (const FileError&) {
  }
}

std::function<bool(std::int64_t)> half_a_second() {
  const auto begin = std::chrono::steady_clock::now();
  return [begin](std::int64_t) { return std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(500); };
}

void resume(const Template& of, const fs::path& folder) {
  attempt([&] {
    (void)run(scenario_of(of.scenario, {"run.steps=8"}),
              {.folder = folder, .existing = Existing::resume, .pulse = half_a_second()});
  });
}

void read_h5(const Template& of, const fs::path& folder, std::size_t how) {
  const fs::path file = folder / of.file;
  switch (how % 4) {
    case 0:
      attempt([&] { (void)first_steps_of(read_for_figure(file, {"energy-error"})); });
      attempt([&] { (void)open_run(file); });
      return;
    case 1:
      attempt([&] {
        const ConvertedRun run(file, "polar");
        (void)run.csv();
        (void)run.json();
        (void)run.write_h5(folder / "converted.h5");
      });
      return;
    case 2:
      attempt([&] { (void)gas_from_run(file, 2); });
      attempt([&] { (void)gas_from_run(file, 2, RunState::start); });
      return;
    default:
      if (of.file == "run.h5") resume(of, folder);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const Template& of = templates()[input.below(templates().size())];
  const fs::path folder = work_folder() / "x";
  std::error_code interrupted;  // by the clock of the fuzzer
  do {
    fs::remove_all(folder);
    interrupted.clear();
    fs::copy(of.folder, folder, interrupted);
  } while (interrupted == std::errc::interrupted);
  const fs::path file = folder / of.file;
  if (!of.places.empty()) {
    const std::size_t how = input.byte();
    {
      const Hdf5Handle h5(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "open the template");
      while (!input.is_over()) change_object(h5, of, input);
    }
    read_h5(of, folder, how);
    return 0;
  }
  const std::vector<std::byte> whole = bytes_of(file);
  const std::vector<std::byte> changed =
      of.file == "members.bin" ? changed_journal(whole, input) : changed_checkpoint(whole, input);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(changed.data()), static_cast<std::streamsize>(changed.size()));
  if (of.file == "checkpoint.bin") resume(of, folder);
  if (of.file == "reversal.bin") {
    attempt([&] {
      (void)reverse_scenario(scenario_of(of.scenario),
                             {.folder = folder, .existing = Existing::resume, .pulse = half_a_second()});
    });
  }
  if (of.file == "members.bin") {
    attempt([&] {
      ScenarioSweep sweep({.text = kepler, .name = "s.toml", .varied = varied, .threads = 1});
      if (sweep.keep_in(folder, Existing::resume).empty()) (void)sweep.run(half_a_second());
    });
  }
  return 0;
}
