// A dropped run.h5 or sweep.h5 as rows of the page.
import { asset_bytes } from "../engine/engine";
import type { FileRows } from "../engine/hdf5_worker";

let worker: Promise<Worker> | undefined;

async function started(): Promise<Worker> {
  const source = await asset_bytes("hdf5", "hdf5.js");
  return new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
}

/// @throws Error with a sentence that names the file
export async function rows_of_file(file: File): Promise<FileRows> {
  worker ??= started();
  const reader = await worker;
  const bytes = await file.arrayBuffer();
  const answer = await new Promise<FileRows | { message: string }>((resolve) => {
    reader.onmessage = (event: MessageEvent<FileRows | { message: string }>) => resolve(event.data);
    reader.postMessage({ name: file.name, bytes }, [bytes]);
  });
  if ("message" in answer) throw new Error(answer.message);
  return answer;
}
