// The column that is y in the picture, against time.
import { Plot } from "../drawing/plot";
import { label_of, made, text_of } from "../page/dom";
import type { MakeView } from "../view";

export const make: MakeView = (laboratory) => {
  const root = made('<figure><figcaption id="series-title"></figcaption><div id="series"></div></figure>');
  const plot = new Plot(root.querySelector("#series")!, 0, (time) => laboratory.mark_time(time));
  return {
    place: "stage",
    order: 40,
    root,
    restyle: () => plot.reset(),
    draw() {
      const { tracks, display } = laboratory;
      const { columns, rows } = tracks[0]!;
      // Where the picture has time on its axis, it is this plot already. Of many bodies a column says little.
      root.hidden = display.x === columns[0] || display.bodies;
      if (root.hidden) return;
      text_of(root, "#series-title", `${label_of(display.y)} against ${columns[0]}`);
      const curves = (): Float64Array[] => tracks.map((track) => track.rows.column(Math.max(track.columns.indexOf(display.y), 0)));
      plot.draw(`${laboratory.version} ${display.y}`, `${columns[0]}${laboratory.unit("time")}`, rows.column(0), curves, laboratory.marked < 0 ? NaN : rows.at(laboratory.row(tracks[0]!), 0));
    },
  };
};
