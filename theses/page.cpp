// Writes index.html: a summary of verdicts, then a section for each experiment. The page contains no times, so the same
// results give the same page, byte for byte, even after interruptions. page/page.html has the parts that do not depend
// on results. The page is a single file that can be read on a phone, in print without colour, and with a screen reader:
// verdicts are words, and figures have alternative texts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "embedded.hpp"
#include "reduce_svg.hpp"
#include "report.hpp"
#include "store.hpp"

namespace hamflow::reproduction {

namespace {
namespace fs = std::filesystem;

std::string escaped_html(const std::string& text) {
  std::string all;
  for (const char c : text) {
    if (c == '&') {
      all += "&amp;";
    } else if (c == '<') {
      all += "&lt;";
    } else if (c == '>') {
      all += "&gt;";
    } else if (c == '"') {
      all += "&quot;";
    } else {
      all += c;
    }
  }
  return all;
}

/// Escapes text for an address within double quotes.
std::string escaped_address(const std::string& text) {
  std::string all;
  for (const char c : text) {
    switch (c) {
      case '%':
      case '#':
      case '"':
      case '<':
      case '>':
      case '&':
        all += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        break;
      case '\n':
      case '\t':
        all += ' ';  // a browser removes line ends from an address
        break;
      default:
        all += c;
    }
  }
  return all;
}

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string class_of(ClaimVerdict verdict) {
  std::string word(name(verdict));
  for (char& c : word) c = c == ' ' ? '-' : c;
  return word;
}

/// A sign before the word of the verdict, for print without colour. Screen readers skip it.
const char* mark_of(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::holds:
      return "&#10003;";
    case ClaimVerdict::differs:
      return "&#8800;";
    case ClaimVerdict::cannot_hold:
      return "&#10007;";
    case ClaimVerdict::undecided:
      return "?";
    case ClaimVerdict::nothing_to_test:
      break;
  }
  return "&#8211;";
}

std::string verdict_html(ClaimVerdict verdict) {
  return fmt::format("<span class=\"verdict {}\"><span aria-hidden=\"true\">{} </span>{}</span>", class_of(verdict),
                     mark_of(verdict), name(verdict));
}

std::string number_html(const Measured& one) {
  std::string text;
  if (std::isnan(one.value)) {
    text = "no number";
  } else if (!std::isfinite(one.uncertainty)) {
    text = fmt::format("{:.3g}, uncertainty unknown", one.value);
  } else {
    text = number_text(one);
    if (one.uncertainty > 0) text += fmt::format(" &plusmn; {:.2g}", one.uncertainty);
  }
  if (!one.how.empty()) text += "<br><span class=\"quiet\">" + escaped_html(one.how) + "</span>";
  return text;
}

/// Says why a claim is undecided, with reference to the numbers in its row.
std::string doubt(const Claim& claim) {
  if (claim.measured.empty()) return "nothing was measured";
  std::string unclear;
  for (std::size_t i = 0; i < claim.measured.size(); ++i) {
    const Judgement alone = judge(claim.rule, {&claim.measured[i], 1}, Grounds::program);
    if (alone.verdict == ClaimVerdict::undecided) unclear += fmt::format("{}{}", unclear.empty() ? "" : ", ", i + 1);
  }
  if (unclear.empty()) return "the ways of measuring disagree";
  const bool is_one_of_many = claim.measured.size() > 1;
  return (is_one_of_many ? "number " + unclear : std::string("it")) + " may lie on either side of the rule";
}

/// The reason of the verdict without its numbers. They have their own cell, so that a screen reader reads them once.
std::string remark_on(const Claim& claim) {
  const std::string& reason = claim.judgement.reason;
  switch (claim.judgement.verdict) {
    case ClaimVerdict::holds:
      return "within the rule";
    case ClaimVerdict::differs:
      return "beyond the rule";
    case ClaimVerdict::cannot_hold:
      return claim.grounds == Grounds::identity ? "beyond the rule, which is an identity"
                                                : "beyond the rule in independent measurements";
    case ClaimVerdict::undecided: {
      const std::size_t run = reason.find("; would decide: ");
      return doubt(claim) + (run == reason.npos ? "" : reason.substr(run));
    }
    case ClaimVerdict::nothing_to_test:
      break;
  }
  return reason;
}

/// Writes the table of claims. It repeats the default roles of a table, because narrow screens show rows as blocks, and
/// these have no roles otherwise.
std::string claims_html(const std::string& id, const std::vector<Claim>& claims) {
  std::string rows;
  for (const Claim& claim : claims) {
    std::string measured;
    for (const Measured& one : claim.measured) measured += (measured.empty() ? "" : "<br>") + number_html(one);
    const auto cell = [](const char* label, const std::string& text) {
      if (text.empty()) return std::string("<td role=\"cell\"></td>");
      return fmt::format("<td role=\"cell\" data-label=\"{}\">{}</td>", label, text);
    };
    rows += fmt::format("<tr role=\"row\" id=\"{}\"><th role=\"rowheader\" scope=\"row\">{}</th>",
                        escaped_html(claim.id), escaped_html(claim.statement)) +
            cell("page", escaped_html(claim.page)) + cell("printed", escaped_html(claim.printed)) +
            cell("measured", measured) + cell("rule", escaped_html(claim.rule.text)) +
            fmt::format("<td role=\"cell\">{}<br><span class=\"quiet\">{}</span></td></tr>\n",
                        verdict_html(claim.judgement.verdict), escaped_html(remark_on(claim)));
  }
  std::string head_row;
  for (const char* heading : {"claim", "page", "printed", "measured", "rule", "verdict"}) {
    head_row += fmt::format("<th role=\"columnheader\" scope=\"col\">{}</th>", heading);
  }
  return "<table class=\"claims\" role=\"table\"><caption class=\"heard\">Claims of " + escaped_html(id) +
         "</caption>\n<thead role=\"rowgroup\"><tr role=\"row\">" + head_row +
         "</tr></thead>\n<tbody role=\"rowgroup\">\n" + rows + "</tbody></table>\n";
}

std::string table_html(const TextTable& table) {
  std::string text = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" + escaped_html(table.caption) +
                     "\"><table class=\"numbers\"><caption>" + escaped_html(table.caption) + "</caption>\n<thead><tr>";
  for (const std::string& heading : table.headings) text += "<th scope=\"col\">" + escaped_html(heading) + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += (i == 0 ? "<th scope=\"row\">" : "<td>") + escaped_html(row[i]) + (i == 0 ? "</th>" : "</td>");
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string figures_html(const fs::path& folder, const StoredResults& kept) {
  std::string all;
  for (const auto& [name, caption, words] : kept.drawings) {
    all += fmt::format(
        "<figure><figcaption>{}</figcaption><img alt=\"{}\" src=\"data:image/svg+xml;charset=utf-8,{}\"></figure>\n",
        escaped_html(caption), escaped_html(words),
        escaped_address(reduce_svg(text_of_file(folder / (name + ".svg")))));
  }
  return all.empty() ? "" : "<div class=\"figures\">\n" + all + "</div>\n";
}

std::string extent_option(WorkExtent extent) { return extent == WorkExtent::usual ? "" : " --" + name_of(extent); }

/// Quotes a word for the shell.
std::string quoted(const std::string& word) {
  const bool plain = word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+-._/") ==
                     std::string::npos;
  return plain ? word : "'" + word + "'";
}

/// Returns shell commands that repeat the scenarios: one for each or, if there are many, the first of each kind and a
/// loop over the files of the folder.
std::string commands_of(const std::string& id, const std::vector<StoredScenario>& scenarios) {
  constexpr std::size_t few = 8, first = 3;
  const std::string folder = "reproduction/" + id + "/";
  std::vector<std::pair<std::string, std::vector<std::string>>> kinds;  // a command and its files
  for (const StoredScenario& scenario : scenarios) {
    auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& one) { return one.first == scenario.command; });
    if (kind == kinds.end()) kind = kinds.insert(kind, {scenario.command, {}});
    kind->second.push_back(quoted(scenario.name + ".toml"));
  }
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const auto& a, const auto& b) { return a.second.size() > b.second.size(); });
  std::string text, cases;
  bool is_loop = false;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto& [command, files] = kinds[k];
    const bool is_told = scenarios.size() <= few || (k > 0 && files.size() <= few);
    for (std::size_t i = 0; i < (is_told ? files.size() : std::min(first, files.size())); ++i) {
      text += "hamflow " + command + " " + folder + files[i] + "\n";
    }
    if (!is_told && files.size() > first) {
      text += fmt::format("# and {} more of the same kind, in {}*.toml\n", files.size() - first, folder);
      is_loop = true;
    }
    if (k == 0) continue;
    for (const std::string& file : files) cases += (cases.empty() || cases.back() == '\n' ? "*/" : "|*/") + file;
    cases += is_told ? ") ;;\n" : ") hamflow " + command + " \"$file\" ;;\n";
  }
  if (!is_loop) return text;
  const std::string most = "hamflow " + kinds[0].first + " \"$file\"";
  return text + "# all of them:\nfor file in " + folder + "*.toml; do " +
         (cases.empty() ? most : "case $file in\n" + cases + "*) " + most + " ;;\nesac") + "; done\n";
}

std::string section_of(const ExperimentReport& report, const fs::path& top) {
  const ExperimentInfo& info = report.info;
  std::string text = fmt::format("<h3 id=\"{0}\">{0}: {1}</h3>\n<p class=\"quiet\">{2}, {3}; size {4}</p>\n",
                                 escaped_html(info.id), escaped_html(info.title), escaped_html(info.thesis),
                                 escaped_html(pages_text(info.page)), name_of(report.extent));
  if (report.status == "failed") return text + "<p>Could not be computed: " + escaped_html(report.message) + "</p>\n";
  if (report.status == "interrupted") return text + "<p>Not computed yet; --resume continues.</p>\n";
  const fs::path folder = top / "reproduction" / info.id;
  const auto kept = read_stored_results(folder, fingerprint_of(info.id, report.extent));
  if (kept) text += figures_html(folder, *kept);
  text += claims_html(info.id, report.claims);
  if (!kept) return text;
  for (const TextTable& table : kept->tables) text += table_html(table);
  for (const std::string& note : kept->notes) text += "<p>" + escaped_html(note) + "</p>\n";
  const std::string commands =
      "hamflow reproduce " + info.id + extent_option(report.extent) + "\n" + commands_of(info.id, kept->scenarios);
  return text + "<details><summary>Commands, in the folder of this page<span class=\"heard\">, of " +
         escaped_html(info.id) + "</span></summary><pre>" + escaped_html(commands) + "</pre></details>\n";
}

/// Lists the claims with a verdict, each as a link to its row.
std::string list_of(const ReproduceReport& report, ClaimVerdict verdict) {
  std::string items;
  int count = 0;
  for (const ExperimentReport& experiment : report.experiments) {
    for (const Claim& claim : experiment.claims) {
      if (claim.judgement.verdict != verdict) continue;
      ++count;
      items += fmt::format("<li><a href=\"#{0}\">{0}</a> {1}{2}</li>\n", escaped_html(claim.id),
                           escaped_html(claim.statement),
                           claim.page.empty() ? "" : ", " + escaped_html(pages_text(claim.page)));
    }
  }
  if (count == 0) return {};
  return fmt::format("<details><summary>{} {}: {}</summary><ul class=\"found\">\n", count,
                     count == 1 ? "claim" : "claims", name(verdict)) +
         items + "</ul></details>\n";
}

/// Writes the contents and the sections of the experiments of one thesis.
std::string thesis_html(const ReproduceReport& report, const std::string& thesis, const fs::path& folder) {
  const std::string called = escaped_html(thesis);
  std::string text =
      fmt::format("<h2 id=\"thesis-{0}\">{0}</h2>\n<nav aria-label=\"Experiments of {0}\"><ul>\n", called);
  std::string sections;
  for (const ExperimentReport& one : report.experiments) {
    if (one.info.thesis != thesis) continue;
    text +=
        fmt::format("<li><a href=\"#{0}\">{0}</a> {1}</li>\n", escaped_html(one.info.id), escaped_html(one.info.title));
    const bool is_short = one.claims.size() <= 2;  // print keeps it on one page
    const std::string section = section_of(one, folder);
    sections += is_short ? "<div class=\"short\">\n" + section + "</div>\n" : section;
  }
  return text + "</ul></nav>\n" + sections;
}
}  // namespace

std::string page_of(const ReproduceReport& report, const fs::path& folder) {
  std::map<ClaimVerdict, int> counts;
  std::vector<std::string> theses;
  for (const ExperimentReport& one : report.experiments) {
    if (theses.empty() || theses.back() != one.info.thesis) theses.push_back(one.info.thesis);
    for (const Claim& claim : one.claims) ++counts[claim.judgement.verdict];
  }
  std::string sources, verdicts, experiments;
  for (const std::string& thesis : theses) {
    sources += fmt::format("<li><a href=\"#thesis-{0}\">{0}</a>: {1}</li>\n", escaped_html(thesis),
                           embedded_text("page/" + thesis + ".html"));
    experiments += thesis_html(report, thesis, folder);
  }
  for (const ClaimVerdict verdict : all_claim_verdicts) {
    verdicts += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", verdict_html(verdict), counts[verdict]);
  }
  std::string page = embedded_text("page/page.html");
  for (const auto& [name, text] :
       {std::pair<std::string, std::string>{"theses", sources},
        {"verdicts", verdicts},
        {"found", list_of(report, ClaimVerdict::cannot_hold) + list_of(report, ClaimVerdict::differs)},
        {"version", escaped_html(HAMFLOW_VERSION)},
        {"experiments", experiments}}) {
    const std::string place = "<!--" + name + "-->";
    page.replace(page.find(place), place.size(), text);
  }
  return page;
}

}  // namespace hamflow::reproduction
