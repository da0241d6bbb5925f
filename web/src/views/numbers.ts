// The numbers of the row that is shown, and of the motion.
import { short } from "../drawing/layout";
import type { Laboratory } from "../laboratory";
import { made, text_of } from "../page/dom";
import type { MakeView } from "../view";

function numbers_of(laboratory: Laboratory): [string, string][] {
  const { motions, recorded } = laboratory;
  const track = laboratory.tracks[0]!;
  if (recorded !== null) return track.columns.slice(0, 40).map((name, i) => [name, short(track.rows.at(laboratory.row(track), i))]);
  const { facts, state } = motions[0]!;
  const walls = state.walls.filter((each) => {
    const wall = facts.walls.find(({ coordinate }) => coordinate === each.coordinate);
    return wall === undefined || (each.side < 0 ? wall.min : wall.max) !== null;
  });
  return [
    ...motions.flatMap((motion): [string, string][] => [
      ["method", motion.facts.method],
      ...(facts.map ? [] : [["largest energy error, relative", (motion.state.energy.max_error / (motion.state.energy.scale || 1)).toExponential(2)] as [string, string]]),
      ["evaluations", String(motion.state.evaluations)],
      ...motion.facts.invariants.map((each, i): [string, string] => [`error of ${each.name}`, motion.state.invariants[i]!.max_error.toExponential(2)]),
    ]),
    ["arithmetic", facts.arithmetic],
    ["dt", short(facts.dt)],
    ["energy", short(state.energy.final)],
    ...walls.map((each): [string, string] => [`bounces of ${facts.q[each.coordinate]} at ${each.side < 0 ? "min" : "max"}`, String(each.bounces)]),
    ...(walls.length > 1 ? [["bounces together", String(walls.reduce((sum, each) => sum + each.bounces, 0))] as [string, string]] : []),
  ];
}

export const make: MakeView = (laboratory) => {
  const root = made('<div><h2>Numbers</h2><p id="status" role="status"></p><table id="facts"></table></div>');
  const table = root.querySelector("table")!;
  return {
    place: "numbers",
    order: 10,
    root,
    draw() {
      const failed = laboratory.recorded === null ? laboratory.motions.find((motion) => motion.state.failed) : undefined;
      const step = laboratory.recorded === null ? `step ${laboratory.first.state.step} of ${laboratory.last_step}${laboratory.turned_at >= 0 ? ", back" : ""}` : "";
      text_of(root, "#status", failed ? `${failed.facts.method}: ${failed.state.message}` : step);
      root.querySelector("#status")!.className = failed ? "bad" : "";
      const all = numbers_of(laboratory);
      while (table.rows.length > all.length) table.deleteRow(-1);
      while (table.rows.length < all.length) table.insertRow().append(Object.assign(document.createElement("th"), { scope: "row" }), document.createElement("td"));
      all.forEach(([name, value], i) => {
        const [head, cell] = table.rows[i]!.children;
        if (head!.textContent !== name) head!.textContent = name;
        if (cell!.textContent !== value) cell!.textContent = value;
      });
    },
  };
};
