// The energy error against time, and that of a second method.
import { Plot } from "../drawing/plot";
import { made, text_of } from "../page/dom";
import type { MakeView } from "../view";

const least_error = 1e-14; // the axis shows at least this much: a few roundings are no drama

export const make: MakeView = (laboratory) => {
  const root = made('<figure id="energy-figure"><figcaption id="energy-title"></figcaption><div id="energy"></div></figure>');
  const plot = new Plot(root.querySelector("#energy")!, least_error, (time) => laboratory.mark_time(time));
  return {
    place: "stage",
    order: 30,
    root,
    restyle: () => plot.reset(),
    draw() {
      const { tracks, recorded, motions } = laboratory;
      const column = tracks[0]!.columns.indexOf("energy error");
      root.hidden = column < 0 || (recorded === null && laboratory.first.facts.map);
      if (root.hidden) return;
      text_of(root, "#energy-title", recorded === null ? "Energy error, (H - H(0)) / scale; the axis shows 1e-14 at least" : "Energy error, H - H(0)");
      const errors = (): Float64Array[] => tracks.map(({ rows }, i) => {
        const scale = recorded === null ? motions[i]!.state.energy.scale || 1 : 1;
        return rows.column(column).map((error) => error / scale);
      });
      const { columns, rows } = tracks[0]!;
      plot.draw(laboratory.version, `${columns[0]}${laboratory.unit("time")}`, rows.column(0), errors, laboratory.marked < 0 ? NaN : rows.at(laboratory.row(tracks[0]!), 0));
    },
  };
};
