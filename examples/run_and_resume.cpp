// A whole run from a program: a scenario as text, a folder with samples and checkpoints, more steps later, a figure.
// usage: example_run_and_resume [FOLDER], default a folder for temporary files
#include <cstdio>
#include <filesystem>

#include "hamflow/workflow/figures_of_run.hpp"
#include "hamflow/workflow/run.hpp"

static const char* const chaos = R"(
[problem]
name = "henon-heiles"
initial = { q = [0, -0.15], p = [0.54, 0.1] }
[method]
name = "stv4"
[run]
dt = 0.1
steps = 20000
lyapunov = 1
)";

int main(int argc, char** argv) try {
  const auto steps = [](const char* n) {
    return hamflow::accepted(hamflow::read_scenario_text(chaos, "chaos", {std::string("run.steps=") + n}));
  };
  hamflow::RunSettings settings;
  settings.folder = argc > 1 ? argv[1] : std::filesystem::temp_directory_path() / "hamflow_run_and_resume";
  settings.existing = hamflow::Existing::replace;
  settings.pulse = [](std::int64_t step) { return std::printf("%lld steps\n", static_cast<long long>(step)) > 0; };
  const hamflow::RunReport first = hamflow::run(steps("20000"), settings);
  std::printf("%s at t = %g, energy within %.1e\n", first.status.c_str(), first.final.time, first.energy.max_error);

  settings.existing = hamflow::Existing::resume;
  const hamflow::RunReport second = hamflow::run(steps("40000"), settings);
  std::printf("\n%s", second.text.c_str());
  hamflow::draw_figure(settings.folder, "energy-error", settings.folder / "energy-error.svg");
  return second.status == "done" ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
