#include "sweep_shards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>
#include <span>

#include "hamflow/core/error.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "sweep_journal.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

std::optional<std::size_t> whole_number(const std::string& text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// "INDEX" and "COUNT" around a separator.
std::optional<SweepShard> shard_in(const std::string& text, const std::string& between) {
  const std::size_t at = text.find(between);
  if (at == std::string::npos) return std::nullopt;
  const auto index = whole_number(text.substr(0, at));
  const auto count = whole_number(text.substr(at + between.size()));
  if (!index || !count) return std::nullopt;
  return SweepShard{*index, *count};
}

/// The shard in the name of a folder, shard-3-of-64.
std::optional<SweepShard> shard_of_folder(const fs::path& folder) {
  const std::string name = folder.filename().string();
  const std::string begin = "shard-";
  if (!name.starts_with(begin)) return std::nullopt;
  const auto shard = shard_in(name.substr(begin.size()), "-of-");
  return shard && shard->index < shard->count ? shard : std::nullopt;
}

/// The shard of this process in a job of several, by the variables of the program that started it.
std::optional<SweepShard> shard_of_environment() {
  const auto number = [](const char* variable) -> std::optional<std::size_t> {
    const char* text = std::getenv(variable);
    return text == nullptr ? std::nullopt : whole_number(text);
  };
  if (const auto task = number("SLURM_ARRAY_TASK_ID")) {
    const auto first = number("SLURM_ARRAY_TASK_MIN");
    const auto count = number("SLURM_ARRAY_TASK_COUNT");
    const std::size_t step = std::max<std::size_t>(number("SLURM_ARRAY_TASK_STEP").value_or(1), 1);
    if (!first || !count || *task < *first || (*task - *first) % step != 0) return std::nullopt;
    return SweepShard{(*task - *first) / step, *count};
  }
  constexpr std::pair<const char*, const char*> ranks[] = {
      {"SLURM_PROCID", "SLURM_NTASKS"}, {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, {"PMI_RANK", "PMI_SIZE"}};
  for (const auto& [index, count] : ranks) {
    if (number(index) && number(count)) return SweepShard{*number(index), *number(count)};
  }
  return std::nullopt;
}

}  // namespace

SweepShard shard_named(const std::string& text) {
  if (text == "auto") {
    const auto shard = shard_of_environment();
    if (shard && shard->index < shard->count) return *shard;
    throw Rejection(option_name("shard"),
                    "found auto, but no number of this process and of all in SLURM_ARRAY_TASK_ID, _MIN and _COUNT, "
                    "SLURM_PROCID and SLURM_NTASKS, OMPI_COMM_WORLD_RANK and _SIZE, or PMI_RANK and _SIZE; allowed "
                    "INDEX/COUNT, e.g. 0/64");
  }
  const auto shard = shard_in(text, "/");
  if (!shard || shard->count == 0) {
    throw Rejection(option_name("shard"), "found \"" + text + "\"; allowed INDEX/COUNT, e.g. 0/64, or auto");
  }
  if (shard->index >= shard->count) {
    throw Rejection(option_name("shard"),
                    fmt::format("found {}; allowed 0/{} to {}/{}", text, shard->count, shard->count - 1, shard->count));
  }
  return *shard;
}

fs::path shard_folder(const SweepShard& shard, const fs::path& folder) {
  if (shard.count == 1) return folder;
  return folder / fmt::format("shard-{}-of-{}", shard.index, shard.count);
}

std::vector<fs::path> shard_folders(const fs::path& folder) {
  std::vector<std::pair<std::pair<std::size_t, std::size_t>, fs::path>> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    if (const auto shard = shard_of_folder(entry.path())) found.push_back({{shard->count, shard->index}, entry.path()});
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> folders;
  for (auto& [order, path] : found) folders.push_back(std::move(path));
  return folders;
}

std::vector<fs::path> shard_journals(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::path& shard : shard_folders(folder)) {
    if (fs::exists(shard / members_file, none)) files.push_back(shard / members_file);
  }
  return files;
}

SweepRequest stored_sweep(const fs::path& folder) {
  std::vector<fs::path> journals = shard_journals(folder);
  if (std::error_code none; fs::exists(folder / members_file, none)) journals.push_back(folder / members_file);
  if (journals.empty()) {
    throw FileError("found no sweep in " + folder.string() + "; allowed a folder with members.bin, or with folders " +
                    "shard-INDEX-of-COUNT");
  }
  SweepIdentity head = read_journal(journals.front()).head;
  return {.text = std::move(head.text),
          .name = std::move(head.name),
          .sets = std::move(head.sets),
          .varied = std::move(head.varied),
          .zip = head.in_step};
}

std::vector<std::string> missing_shards(const fs::path& folder, const std::vector<bool>& is_finished) {
  std::size_t count = 0;
  for (const fs::path& file : shard_journals(folder)) count = shard_of_folder(file.parent_path())->count;
  std::set<std::size_t> missing;
  for (std::size_t member = 0; count > 0 && member < is_finished.size(); ++member) {
    if (!is_finished[member]) missing.insert(member % count);
  }
  std::vector<std::string> names;
  for (const std::size_t index : missing) names.push_back(fmt::format("{}/{}", index, count));
  return names;
}

std::uint64_t functions_of_this_machine() {
  std::vector<double> values;
  for (int i = 1; i <= 64; ++i) {
    const double x = 0.1357 * i;
    for (const double value : {sin(x), cos(x), tan(x), exp(x), log(x), pow(x, 1.7), sinh(x), cosh(x), tanh(x), atan(x),
                               atan2(x, 1.3), asin(x / 16), acos(x / 16)}) {
      values.push_back(value);
    }
  }
  return fnv1a(std::as_bytes(std::span(values)));
}

}  // namespace hamflow
