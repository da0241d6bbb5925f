"""The manual page of the command, made from its --help and from the --help of each subcommand."""

import re
import subprocess


def help_of(program: str, *words: str) -> str:
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout


def roff(text: str) -> str:
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in text.splitlines())


def sections(text: str) -> dict[str, list[str]]:
    """The lines below each heading ("Options:"); what stands before the first one has the heading ""."""
    found: dict[str, list[str]] = {"": []}
    lines = found[""]
    for line in text.splitlines():
        if re.match(r"(Options|Subcommands|Positionals|Examples):$", line):
            lines = found.setdefault(line[:-1], [])
        elif line.startswith("Exit status:"):
            found["Exit status"] = [line.removeprefix("Exit status: ")]
        elif line.strip():
            lines.append(line)
    return found


def described(lines: list[str]) -> str:
    """Names and their descriptions, which two spaces or more separate."""
    text = ""
    for line in lines:
        name, _, description = re.sub(r"^ +", "", line).partition("  ")
        text += f".TP\n.B {roff(name)}\n{roff(description.strip())}\n"
    return text


def examples(lines: list[str]) -> str:
    return ".PP\nExamples:\n.PP\n.nf\n" + roff("\n".join(lines)) + "\n.fi\n" if lines else ""


def man_page(program: str, version: str, month: str) -> str:
    whole = sections(help_of(program))
    text = f'.TH HAMFLOW 1 "{month}" "hamflow {version}" "User Commands"\n'
    text += f".SH NAME\nhamflow \\- {roff(whole[''][0].removeprefix('hamflow ').rstrip('.'))}\n"
    text += ".SH SYNOPSIS\n.B hamflow\n.I SUBCOMMAND\n[\\fIOPTIONS\\fR]\n"
    text += ".SH DESCRIPTION\nEach subcommand has its own \\fB\\-\\-help\\fR.\n" + described(whole["Options"])
    text += ".SH SUBCOMMANDS\n"
    for line in whole["Subcommands"]:
        name = line.split()[0]
        its = sections(help_of(program, name))
        usage = next((line.removeprefix("Usage: ") for line in its[""] if line.startswith("Usage: ")), f"hamflow {name}")
        sentences = [line for line in its[""] if not line.startswith("Usage: ")]
        text += f".SS {roff(usage)}\n{roff(' '.join(sentences))}\n"
        text += described(its.get("Positionals", []) + [line for line in its.get("Options", []) if "--help" not in line])
        text += examples(its.get("Examples", []))
    text += f".SH EXIT STATUS\n{roff(' '.join(whole['Exit status']))}\n"
    return text + ".SH SEE ALSO\ngnuplot(1), which draws the figures\n"
