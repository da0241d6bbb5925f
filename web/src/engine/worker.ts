// The worker: one instance of the engine. It gets the compiled modules of its parts and requests, and answers each of these.
import hamflowEngine, { type EngineModule } from "hamflow-engine";
import { instantiate } from "./parts";
import type { Part, Question, Reply } from "./protocol";

const scope = self as unknown as { onmessage: (event: MessageEvent) => void; postMessage(message: unknown, transfer: Transferable[]): void };
let engine: Promise<EngineModule>;
let rest: WebAssembly.Module | undefined;
let rest_address = "";

/// Before the rest is there, the page asks only what does not need it (Engine.first_suffices). If a function of the rest
/// is called all the same, the worker waits for it here.
function rest_at_once(): WebAssembly.Module {
  if (rest !== undefined) return rest;
  const request = new XMLHttpRequest();
  request.open("GET", rest_address, false);
  request.responseType = "arraybuffer";
  request.send();
  return (rest = new WebAssembly.Module(request.response as ArrayBuffer));
}
function start(module: WebAssembly.Module): Promise<EngineModule> {
  return hamflowEngine({
    instantiateWasm(imports, done) {
      const instance = instantiate(module, imports, rest_at_once);
      done(instance, module);
      return instance.exports;
    },
  });
}

/// Puts a text into the memory of the engine.
function stored(module: EngineModule, text: string): number {
  const bytes = module.lengthBytesUTF8(text) + 1;
  const address = module._malloc(bytes);
  module.stringToUTF8(text, address, bytes);
  return address;
}

function numbers(module: EngineModule, address: number, count: number): Float64Array {
  return module.HEAPF64.slice(address / 8, address / 8 + count);
}

function answer(module: EngineModule, request: Question): Reply {
  const texts: number[] = [];
  const args = request.args.map((arg) => {
    if (typeof arg === "number") return arg;
    texts.push(stored(module, arg));
    return texts[texts.length - 1]!;
  });
  const call = module[`_hamflow_${request.call}`] as (...args: number[]) => number;
  const json = module.UTF8ToString(call(request.motion, ...args));
  for (const text of texts) module._free(text);
  const response: Reply = { id: request.id, json, rows: null, points: null };
  if (json.startsWith('{"errors"')) return response;
  if (request.call === "open" || request.call === "show" || request.call === "advance") {
    response.rows = numbers(module, module._hamflow_rows(request.motion), module._hamflow_count(request.motion));
    response.points = numbers(module, module._hamflow_points(request.motion), module._hamflow_point_count(request.motion));
  } else if (request.call === "cells") {
    response.rows = numbers(module, module._hamflow_cell_numbers!(0), module._hamflow_cell_count!(0));
  } else if (request.call === "points_of_starts") {
    response.rows = numbers(module, module._hamflow_start_numbers!(0), module._hamflow_start_number_count!(0));
  }
  return response;
}

function answered(module: EngineModule, request: Question): Reply {
  try {
    return answer(module, request);
  } catch (error) {
    return { id: request.id, json: JSON.stringify({ errors: [{ line: 0, column: 0, key: "", message: String(error) }] }), rows: null, points: null };
  }
}

scope.onmessage = (event) => {
  const message = event.data as Part | Question;
  if ("first" in message) {
    rest_address = message.rest_address;
    engine = start(message.first);
    return;
  }
  if ("rest" in message) {
    rest = message.rest;
    return;
  }
  const request = message;
  void engine.then((module) => {
    const response = answered(module, request);
    const transfer = [response.rows, response.points].filter((all) => all !== null).map((all) => all.buffer as ArrayBuffer);
    scope.postMessage(response, transfer);
  });
};
