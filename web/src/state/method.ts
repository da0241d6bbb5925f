// The same scenario with another method.

/// Replaces the table [method] by one with this name alone; the text has no such table in other notations.
export function with_method(toml: string, name: string): string {
  const lines = toml.split("\n");
  const from = lines.findIndex((line) => /^\s*\[method\]/.test(line));
  const table = ["[method]", `name = "${name}"`, ""];
  if (from < 0) return [...lines, ...table].join("\n");
  const length = lines.slice(from + 1).findIndex((line) => /^\s*\[/.test(line));
  lines.splice(from, length < 0 ? lines.length - from : length + 1, ...table);
  return lines.join("\n");
}
