// A dropped run.h5 or sweep.h5 as rows of the page.
import { asset_bytes } from "../engine/data";
import type { FileRows } from "../engine/hdf5_worker";

const most_bytes = 200e6;

let started_worker: Promise<Worker> | undefined;

async function started(): Promise<Worker> {
  const [source, library] = await Promise.all([asset_bytes("hdf5", "hdf5.js"), asset_bytes("hdf5-library", "hdf5.wasm")]);
  const worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
  worker.postMessage(library, [library]);
  return worker;
}

/// @throws Error with a sentence that names the file
export async function rows_of_file(file: File): Promise<FileRows> {
  if (file.size > most_bytes) throw new Error(`${file.name} has ${Math.round(file.size / 1e6)} MB; a page reads at most ${most_bytes / 1e6} MB: hamflow view makes a page of every n-th row`);
  started_worker ??= started();
  const [reader, bytes] = await Promise.all([started_worker, file.arrayBuffer()]);
  const answer = await new Promise<FileRows | { message: string }>((resolve) => {
    reader.onmessage = (event: MessageEvent<FileRows | { message: string }>) => resolve(event.data);
    reader.postMessage({ name: file.name, bytes }, [bytes]);
  });
  if ("message" in answer) throw new Error(answer.message);
  return answer;
}
