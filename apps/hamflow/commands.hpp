// The sub-commands. Each returns the exit status: 0: done; 1: the run failed (numerics); 2: the request was wrong and
// nothing ran; 3: input or output failed; 130: Ctrl-C stopped the command.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace hamflow::app {

enum ExitStatus { exit_done = 0, exit_failed = 1, exit_rejected = 2, exit_file = 3, exit_interrupted = 130 };

struct RunOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::string out;  // a folder, "none", or empty for the default
  bool force = false;
  bool resume = false;
  bool json = false;
  bool quiet = false;
};
int run_command(const RunOptions& options);

struct SweepCommandOptions {
  std::string scenario;
  std::vector<std::string> varied;  // PATH=a:b:n, PATH=v1,v2,... or PATH=FORMULA
  bool zip = false;                 // pair the n-th values of all keys; false: every combination
  std::vector<std::string> sets;
  std::string out;    // a folder, "none", or empty for <stem>.sweep
  std::string lanes;  // auto, none, generic, avx2, avx512
  int threads = 0;    // 0: the scenario's number, or all cores if it has none
  bool force = false;
  bool resume = false;
  bool json = false;
  bool quiet = false;
  std::string figure;  // a file; empty: none
  std::string colour;  // a column; empty: the Poincare section if the run has one, else energy/max_error
  bool mean = false;   // draw means of the columns over all varied keys except the first
  std::string shard;   // INDEX/COUNT or "auto"; empty: all members
  std::string merge;   // the folder of a sweep in shards; empty: none
};
int sweep_command(const SweepCommandOptions& options);

struct PlotOptions {
  std::vector<std::string> runs;  // folders or their run.h5
  std::string kind;               // empty: orbit if the problem has one, else phase
  std::string file;
  std::string x;     // a column
  std::string y;     // columns, separated by commas
  std::string at;    // times, separated by commas
  std::string size;  // WxH in centimetres, or with a unit
  int dpi = 0;
  bool no_title = false;
};
int plot_command(const PlotOptions& options);

struct ViewOptions {
  std::string input;    // a run, a sweep or a scenario; empty: the laboratory alone
  std::string file;     // empty: NAME.html
  bool browser = true;  // open it
};
int view_command(const ViewOptions& options);

struct VerifyOptions {
  std::vector<std::string> methods;  // as on the command line, e.g. "stv4", "cg(1,5)"
  bool all = false;                  // measure every method of the catalogue
  std::string problem;               // empty: the default problems
  bool json = false;
};
/// Returns 1 if a claim differs from its measurement.
int verify_command(const VerifyOptions& options);

struct CertifyOptions {
  std::string file;    // csv, columns, log.lammps, HDF5
  std::string time;    // a column, by name or number; in HDF5 the path of a dataset
  std::string energy;  // likewise
  std::string scale;   // a number; empty: the absolute value of the first energy
  bool json = false;
};
int certify_command(const CertifyOptions& options);

struct NewOptions {
  std::string problem;
  std::map<std::string, std::string> variant;  // e.g. potential = kepler; empty: not given
  std::string method;                          // with its options; empty: the usual one
  bool all = false;                            // every key, not those alone that are set
};
int new_command(const NewOptions& options);

struct ConvertOptions {
  std::string input;  // a scenario, the folder of a run or its run.h5; empty: the options give a state
  std::string to;
  std::string from;  // coordinates of the given state
  std::string q;     // numbers, separated by commas
  std::string p;
  std::string output;  // empty: standard output
  std::vector<std::string> sets;
  bool json = false;
};
int convert_command(const ConvertOptions& options);

struct ReverseOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::string out;  // a folder; empty or "none": nothing is written
  bool force = false;
  bool resume = false;
  bool json = false;
  bool quiet = false;
};
int reverse_command(const ReverseOptions& options);

struct CompareOptions {
  std::string scenario;
  std::vector<std::string> sets;
  std::string methods;  // separated by commas; commas inside parentheses belong to a method
  std::string dts;      // numbers, separated by commas; empty: from twice the scenario's dt to a sixteenth of it
  std::string out;      // a folder; empty or "none": nothing is written
  std::string csv;      // a file
  std::string figure;   // .svg, .pdf or .png
  bool force = false;
  bool json = false;
  bool quiet = false;
};
int compare_command(const CompareOptions& options);

struct ShellOptions {
  std::string scenario;
  std::vector<std::string> sets;
  bool json = false;
  bool quiet = false;
};
int shell_command(const ShellOptions& options);

/// Starts hamflow-reproduce with these arguments; returns only if the start fails.
int reproduce_command(const std::vector<std::string>& arguments);

/// @param name a run, a scenario file, a method or a problem
int cite_command(const std::string& name);
int list_command(const std::string& what, bool all, bool json);
/// @param folder of a reproduction, for an experiment; empty: the folder into which `reproduce` writes
int show_command(const std::string& name, const std::string& folder);

}  // namespace hamflow::app
