// Files and texts that the page makes.

export function save(name: string, content: Blob): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function save_text(name: string, text: string, type: string): void {
  save(name, new Blob([text], { type }));
}

/// Rows of numbers in the shortest digits that read back as the same doubles.
export function csv_of(columns: string[], rows: Iterable<ArrayLike<number>>): string {
  const lines = [columns.map((name) => (/[",]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name)).join(",")];
  for (const row of rows) lines.push(Array.from(row).join(","));
  return lines.join("\n") + "\n";
}

export function as_python(toml: string): string {
  const text = toml.includes('"""') || toml.includes("\\") ? JSON.stringify(toml) : `"""\n${toml}"""`;
  return `import hamflow as hf\n\nscenario = hf.Scenario.from_text(${text})\nscenario.set("run.functions", "portable")  # as in the laboratory\nrun = hf.run(scenario)\nprint(run)\n`;
}

export function as_command(toml: string): string {
  return `cat > scenario.toml <<'END'\n${toml.replace(/\n?$/, "\n")}END\nhamflow run scenario.toml --set run.functions=portable\n`;
}
