// Files that are dropped on the page or chosen: scenarios, runs and sweeps.
import type { FileRows } from "../engine/hdf5_worker";
import { rows_of_file } from "../state/hdf5";
import { element } from "./dom";

const hdf5_magic = [0x89, 0x48, 0x44, 0x46];

async function open_file(file: File, open_text: (toml: string) => void, show_recorded: (rows: FileRows) => void): Promise<void> {
  const head = new Uint8Array(await file.slice(0, 4).arrayBuffer());
  if (hdf5_magic.every((byte, i) => head[i] === byte)) {
    show_recorded(await rows_of_file(file));
  } else if (file.name.endsWith(".toml")) {
    open_text(await file.text());
  } else {
    throw new Error(`${file.name} is no scenario (.toml) and no run.h5 or sweep.h5 of hamflow; drop one of these`);
  }
}

export function connect_files(open_text: (toml: string) => void, show_recorded: (rows: FileRows) => void, complain: (error: unknown) => void): void {
  const take = (file: File | undefined): void => {
    if (file !== undefined) open_file(file, open_text, show_recorded).catch((error: unknown) => complain(error instanceof Error ? error.message : error));
  };
  document.ondragover = (event) => event.preventDefault();
  document.ondrop = (event) => {
    event.preventDefault();
    take(event.dataTransfer?.files[0]);
  };
  const chooser = element<HTMLInputElement>("file");
  element("open-file").onclick = () => chooser.click();
  chooser.onchange = () => {
    take(chooser.files?.[0]);
    chooser.value = "";
  };
}
