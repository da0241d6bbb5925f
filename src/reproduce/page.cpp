// index.html: a summary of verdicts, then a section for each experiment. It is one file that needs no other, readable
// on a telephone, in print without colour, and by a screen reader: verdicts are words, figures have alternative texts.
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <sstream>

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

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string all;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      word = word << 8 | (k < there ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) all += k <= there ? digits[word >> (18 - 6 * k) & 63] : '=';
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

const char* const head = R"(<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>hamflow: both theses, figure by figure</title>
<style>
  :root { color-scheme: light dark; --text: #222; --quiet: #5a5a5a; --line: #d8d8d4; --code: #f4f4f1; --link: #0072b2; }
  @media (prefers-color-scheme: dark) {
    :root { --text: #e4e4e0; --quiet: #a8a8a2; --line: #44443f; --code: #262624; --link: #6cb8ea; }
  }
  * { box-sizing: border-box; }
  body { font: 16px/1.55 system-ui, sans-serif; max-width: 72rem; margin: 0 auto; padding: 1rem; color: var(--text); }
  h1 { font-size: 1.7rem; margin: 1rem 0 0; }
  h2 { font-size: 1.4rem; margin: 2.5rem 0 0.3rem; }
  h3 { font-size: 1.15rem; margin: 2rem 0 0.3rem; padding-top: 1rem; border-top: 1px solid var(--line); overflow-wrap: anywhere; }
  p { max-width: 46rem; }
  a { color: var(--link); }
  figure { margin: 0.5rem 0; max-width: 44rem; }
  .figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 22rem), 1fr)); gap: 1rem; align-items: start; }
  img { display: block; width: 100%; height: auto; background: white; border: 1px solid var(--line); border-radius: 4px; }
  figcaption { margin-bottom: 0.3rem; font-size: 0.9rem; }
  table { border-collapse: collapse; width: 100%; font-size: 0.9rem; }
  th, td { text-align: left; vertical-align: top; padding: 0.35rem 0.6rem 0.35rem 0; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
  .verdict { white-space: nowrap; font-weight: 600; padding: 0.05rem 0.4rem; border-radius: 3px; border: 2px solid; }
  .holds { color: #00705a; border-style: solid; }
  .differs { color: #b04a00; border-style: dashed; }
  .cannot-hold { color: #a01050; border-style: double; border-width: 4px; }
  .undecided { color: #7a6000; border-style: dotted; }
  .nothing-to-test { color: #5a5a5a; border-color: transparent; font-weight: 400; }
  @media (prefers-color-scheme: dark) {
    .holds { color: #4cc9a8; } .differs { color: #f0985a; } .cannot-hold { color: #ff80b5; } .undecided { color: #e0c050; }
    .nothing-to-test { color: #a8a8a2; }
  }
  pre { background: var(--code); padding: 0.6rem; margin: 0.5rem 0; white-space: pre-wrap; overflow-wrap: anywhere; font: 0.8rem/1.45 ui-monospace, monospace; border-radius: 4px; }
  .quiet { color: var(--quiet); font-size: 0.9rem; }
  @media (max-width: 40rem) {
    table.claims, table.claims tbody, table.claims tr, table.claims td { display: block; width: 100%; }
    table.claims thead { display: none; }
    table.claims td { border: 0; padding: 0.1rem 0; }
    table.claims td[data-label]::before { content: attr(data-label) ": "; color: var(--quiet); }
    table.claims tr { border-bottom: 1px solid var(--line); padding: 0.5rem 0; }
  }
</style>
)";

std::string verdict_html(ClaimVerdict verdict) {
  return fmt::format("<span class=\"verdict {}\">{}</span>", class_of(verdict), name(verdict));
}

std::string number_html(const Measured& one) {
  std::string text = fmt::format("{:.8g}", one.value);
  if (one.uncertainty > 0) text += fmt::format(" &plusmn; {:.2g}", one.uncertainty);
  if (!one.how.empty()) text += "<br><span class=\"quiet\">" + escaped_html(one.how) + "</span>";
  return text;
}

std::string claims_html(const std::vector<Claim>& claims) {
  std::string rows;
  for (const Claim& claim : claims) {
    std::string measured;
    for (const Measured& one : claim.measured) measured += (measured.empty() ? "" : "<br>") + number_html(one);
    rows += fmt::format(
        "<tr id=\"{}\"><td>{}</td><td data-label=\"page\">{}</td><td data-label=\"printed\">{}</td><td "
        "data-label=\"measured\">{}</td><td data-label=\"rule\">{}</td><td>{}<br><span "
        "class=\"quiet\">{}</span></td></tr>\n",
        escaped_html(claim.id), escaped_html(claim.statement), escaped_html(claim.page), escaped_html(claim.printed),
        measured, escaped_html(claim.rule.text), verdict_html(claim.judgement.verdict),
        escaped_html(claim.judgement.reason));
  }
  return "<table class=\"claims\"><thead><tr><th scope=\"col\">claim</th><th scope=\"col\">page</th><th "
         "scope=\"col\">printed</th><th scope=\"col\">measured</th><th scope=\"col\">rule</th><th "
         "scope=\"col\">verdict</th></tr></thead><tbody>\n" +
         rows + "</tbody></table>\n";
}

std::string figures_html(const fs::path& folder, const Kept& kept) {
  std::string all;
  for (const auto& [name, caption] : kept.drawings) {
    all += fmt::format(
        "<figure><figcaption>{}</figcaption><img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\"></figure>\n",
        escaped_html(caption), escaped_html(caption), base64(text_of_file(folder / (name + ".svg"))));
  }
  return all.empty() ? "" : "<div class=\"figures\">\n" + all + "</div>\n";
}

std::string extent_option(WorkExtent extent) {
  return extent == WorkExtent::quick ? " --quick" : extent == WorkExtent::full ? " --full" : "";
}

std::string section_of(const ExperimentReport& report, const ReproduceRequest& request) {
  const ExperimentInfo& info = report.info;
  std::string text =
      fmt::format("<h3 id=\"{0}\">{0}: {1}</h3>\n<p class=\"quiet\">{2}, page {3}</p>\n", escaped_html(info.id),
                  escaped_html(info.title), escaped_html(info.thesis), escaped_html(info.page));
  if (report.status == "failed") return text + "<p>Could not be computed: " + escaped_html(report.message) + "</p>\n";
  if (report.status == "interrupted") return text + "<p>Not computed yet: --resume goes on.</p>\n";
  const fs::path folder = request.folder / "reproduction" / info.id;
  const auto kept = kept_in(folder, fingerprint_of(info.id, request.extent));
  if (kept) text += figures_html(folder, *kept);
  text += claims_html(report.claims);
  if (!kept) return text;
  for (const std::string& note : kept->notes) text += "<p>" + escaped_html(note) + "</p>\n";
  std::string commands = "hamflow reproduce " + info.id + extent_option(request.extent) + "\n";
  for (const std::string& scenario : kept->scenarios) {
    commands += "hamflow run reproduction/" + info.id + "/" + scenario + ".toml\n";
  }
  return text + "<details><summary>Commands, in the folder of this page</summary><pre>" + escaped_html(commands) +
         "</pre></details>\n" + fmt::format("<p class=\"quiet\">{:.1f} s</p>\n", report.seconds);
}
}  // namespace

std::string page_of(const ReproduceReport& report, const ReproduceRequest& request) {
  std::map<ClaimVerdict, int> counts;
  double seconds = 0;
  for (const ExperimentReport& one : report.experiments) {
    seconds += one.seconds;
    for (const Claim& claim : one.claims) ++counts[claim.judgement.verdict];
  }
  std::string text = head;
  text +=
      "<body>\n<h1>Both theses, figure by figure</h1>\n<p>What was printed, what hamflow measured, and the rule by "
      "which the two were judged. No verdict was typed in: each is computed from its numbers. A claim <em>holds</em> "
      "where everything that the measured number may be lies within the rule, <em>differs</em> where nothing of it "
      "does, <em>cannot hold</em> where it is wrong whatever the program: by an identity, or in two independent "
      "ways. It is <em>undecided</em> where the number is too uncertain.</p>\n<table><caption "
      "class=\"quiet\">Verdicts</caption>\n";
  for (const ClaimVerdict verdict : all_claim_verdicts) {
    text += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", verdict_html(verdict), counts[verdict]);
  }
  text += "</table>\n";
  std::string thesis;
  for (const ExperimentReport& one : report.experiments) {
    if (one.info.thesis != thesis) {
      thesis = one.info.thesis;
      text += "<h2>" + escaped_html(thesis) + "</h2>\n<p>";
      for (const ExperimentReport& other : report.experiments) {
        if (other.info.thesis == thesis) {
          text += fmt::format("<a href=\"#{0}\">{0}</a> ", escaped_html(other.info.id));
        }
      }
      text += "</p>\n";
    }
    text += section_of(one, request);
  }
  return text + fmt::format("<p class=\"quiet\">hamflow {}, {:.0f} s of work.</p>\n</body>\n</html>\n",
                            escaped_html(HAMFLOW_VERSION), seconds);
}

}  // namespace hamflow::reproduction
