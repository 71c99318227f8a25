// Whether the ES modules do what roio::pack() and roio::unpack() do: check_modules.mjs FOLDER, with what
// make_property wrote there.
import {readFileSync} from "node:fs";
import {pathToFileURL} from "node:url";

const folder = process.argv[2];
const modules = {};
let checks = 0;

const fromHex = (text) => Uint8Array.from(Buffer.from(text, "hex"));
const toHex = (bytes) => Buffer.from(bytes).toString("hex").toUpperCase();
const isBytes = (value) => value !== null && typeof value === "object";
const shown = (values) =>
  values && Object.fromEntries(Object.entries(values).map(([name, value]) =>
    [name, value instanceof Uint8Array ? {hex: toHex(value)} : value]));
const meant = (values) =>
  Object.fromEntries(Object.entries(values).map(([name, value]) =>
    [name, isBytes(value) ? fromHex(value.hex) : value]));
const sorted = (values) => values && JSON.stringify(Object.entries(values).sort(([a], [b]) => (a < b ? -1 : 1)));

function expect(line, what, found, wanted) {
  ++checks;
  if (found !== wanted) {
    console.log(`${JSON.stringify(line)}\n  ${what}: ${found}; expected ${wanted}`);
    process.exitCode = 1;
  }
}

function checkPack(line, message) {
  let found = null;
  try {
    found = toHex(message.pack(meant(line.values)));
  } catch (error) {
    expect(line, "error", error.constructor, RangeError);
    const fields = message.fields.map((field) => `${message.name}.${field.name}: `);
    expect(line, "names its field", fields.some((field) => error.message.startsWith(field)), true);
  }
  expect(line, "packed", found, line.packed && line.packed.hex);
}

function checkUnpack(line, module, message) {
  const bytes = fromHex(line.bytes.hex);
  expect(line, "unpacked", sorted(shown(message.unpack(bytes))), sorted(line.unpacked));
  const any = module.unpack(module[line.direction], bytes);
  expect(line, "name", any && any.name, line.name);
}

for (const text of readFileSync(`${folder}/lines`, "utf8").split("\n").filter(Boolean)) {
  const line = JSON.parse(text);
  modules[line.kind] ??= await import(pathToFileURL(`${folder}/${line.kind}.mjs`));
  const module = modules[line.kind];
  const message = module[line.direction][line.message];
  if ("values" in line) {
    checkPack(line, message);
  } else {
    checkUnpack(line, module, message);
  }
}
console.log(`${checks} checks`);
