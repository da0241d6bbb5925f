// The axes of a section, and the start that belongs to a point of it.
import type { Facts } from "../engine/protocol";

export interface SectionAxes {
  x: number; // columns of a point: t, then all q, then all p
  y: number;
  x_name: string;
  y_name: string;
  /// PATH=VALUE
  start(x: number, y: number): string;
}

/// null: a click would not determine a start.
export function axes_of(facts: Facts, energy: number): SectionAxes | null {
  const section = facts.section;
  const n = facts.q.length;
  if (section === null) return null;
  if (n === 1 && !section.is_plane) {
    return { x: 1, y: 2, x_name: facts.q[0]!, y_name: facts.p[0]!, start: (x, y) => `problem.initial={ q = [${x}], p = [${y}] }` };
  }
  if (n !== 2 || !section.is_plane || section.momentum) return null;
  const fixed = section.coordinate;
  const other = 1 - fixed;
  const pair = (at_fixed: string | number, at_other: number): string => (fixed === 0 ? `${at_fixed}, ${at_other}` : `${at_other}, ${at_fixed}`);
  const root = section.direction < 0 ? '"-"' : '"+"';
  return {
    x: 1 + other,
    y: 3 + other,
    x_name: facts.q[other]!,
    y_name: facts.p[other]!,
    start: (x, y) => `problem.initial={ q = [${pair(section.value, x)}], p = [${pair(root, y)}], energy = ${energy} }`,
  };
}
