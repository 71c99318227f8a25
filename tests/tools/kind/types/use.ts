// What a program in TypeScript sees of a module: everything.js, made from everything.kind.json.
import {heard, said, unpack} from "./everything.js";

const bytes: Uint8Array = heard.set.pack({fast: 1, way: "open", "angle-x": -3.5});
heard.set.pack({fast: 1, way: "shut", "angle-x": 0, rest: new Uint8Array(2)});
heard.ask.pack({});
const values = heard.set.unpack(bytes);
if (values !== null) {
  const angle: number = values["angle-x"];
  const way: "open" | "shut" = values.way;
  const rest: Uint8Array | undefined = values.rest;
}
const problem: string | null = heard.set.problem({fast: 2, way: "open", "angle-x": 0});
const any: {name: string; values: object} | null = unpack(heard, bytes) ?? unpack(said, bytes);

// @ts-expect-error: no such choice
heard.set.pack({fast: 1, way: "ajar", "angle-x": 0});
// @ts-expect-error: a field is missing
heard.set.pack({fast: 1, way: "open"});
// @ts-expect-error: no such field
heard.set.pack({fast: 1, way: "open", "angle-x": 0, slow: 1});
// @ts-expect-error: no such message
heard.stop;
// @ts-expect-error: it may be another message
heard.set.unpack(bytes).fast;
