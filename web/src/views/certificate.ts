// What the motion concludes about its own errors, and what came back after a reversal.
import type { Certificate } from "../engine/protocol";
import { made, text_of } from "../page/dom";
import type { MakeView } from "../view";

function lines_of({ method, found }: { method: string; found: Certificate }): { text: string; bad: boolean }[] {
  const lines = [{ text: `energy error ${found.drift}: ${found.reason}`, bad: found.drift === "linear" }];
  for (const each of found.invariants) if (each.conserved !== null) lines.push({ text: `${each.name} ${each.conserved ? "conserved" : "not conserved"}`, bad: !each.conserved });
  if (found.reversal !== null) {
    const { proves, reason } = found.reversal;
    lines.push({ text: `${proves === "nothing" ? "reversal inconclusive" : proves}: ${reason}`, bad: false });
  }
  return lines.map(({ text, bad }) => ({ text: `${method}: ${text}`, bad }));
}

export const make: MakeView = (laboratory) => {
  const root = made('<div><h2>Certificate</h2><ul id="certificate"></ul><p id="returned" role="status"></p></div>');
  let shown: unknown;
  return {
    place: "numbers",
    order: 20,
    root,
    draw() {
      root.hidden = laboratory.recorded !== null || (laboratory.first.facts.map && laboratory.returned === "");
      text_of(root, "#returned", laboratory.returned);
      if (shown === laboratory.certificates) return;
      shown = laboratory.certificates;
      const items = laboratory.certificates.flatMap(lines_of).map(({ text, bad }) => Object.assign(document.createElement("li"), { textContent: text, className: bad ? "bad" : "" }));
      root.querySelector("ul")!.replaceChildren(...items);
    },
  };
};
