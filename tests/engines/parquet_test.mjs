// Tables that the library wrote as Parquet, read by hyparquet and by DuckDB: their names, types and
// numbers against the packed rows, bit by bit.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync, rmSync} from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';

import {DuckDBInstance} from '@duckdb/node-api';
import {asyncBufferFromFile, parquetMetadataAsync, parquetRead} from 'hyparquet';

const folder = process.env.IST_TABLES;
rmSync(folder, {recursive: true, force: true});
mkdirSync(folder, {recursive: true});
execFileSync(process.env.IST_WRITE_TABLES, [folder]);
const tables = JSON.parse(readFileSync(path.join(folder, 'tables.json'), 'utf8'));

const arrays = {uint64: BigUint64Array, int32: Int32Array, float64: Float64Array};
const parquetFile = (name) => path.join(folder, `${name}.parquet`);

/** The bytes of a column's values in the packed rows. */
function bytesOf(rows, {offset, type}, stride) {
  const size = arrays[type].BYTES_PER_ELEMENT;
  const bytes = Buffer.alloc((rows.length / stride) * size);
  for (let row = 0; row * stride < rows.length; ++row) {
    rows.copy(bytes, row * size, row * stride + offset, row * stride + offset + size);
  }
  return bytes;
}

/** Compares columns, each a list of typed arrays, with the packed rows. */
function assertSameNumbers(name, columns) {
  const table = tables[name];
  const rows = readFileSync(path.join(folder, `${name}.rows`));
  assert.equal(rows.length, table.rows * table.row_bytes);
  assert.equal(columns.length, table.columns.length);
  table.columns.forEach((column, i) => {
    for (const piece of columns[i]) assert.equal(piece.constructor, arrays[column.type], column.name);
    const bytes = Buffer.concat(columns[i].map((piece) => Buffer.from(piece.buffer, piece.byteOffset, piece.byteLength)));
    assert.ok(bytes.equals(bytesOf(rows, column, table.row_bytes)), `${column.name} has the bits of its numbers`);
  });
}

const unsigned = {type: 'INTEGER', bitWidth: 64, isSigned: false};
const elements = {
  uint64: {type: 'INT64', converted_type: 'UINT_64', logical_type: unsigned},
  int32: {type: 'INT32', converted_type: undefined, logical_type: undefined},
  float64: {type: 'DOUBLE', converted_type: undefined, logical_type: undefined},
};

async function readByHyparquet(name) {
  const table = tables[name];
  const file = await asyncBufferFromFile(parquetFile(name));
  const metadata = await parquetMetadataAsync(file);
  assert.equal(metadata.created_by, 'ist');
  assert.equal(Number(metadata.num_rows), table.rows);
  assert.equal(metadata.row_groups.length, table.groups);
  assert.equal(metadata.schema[0].num_children, table.columns.length);
  metadata.schema.slice(1).forEach((element, i) => {
    const {type, converted_type, logical_type, repetition_type} = element;
    assert.equal(element.name, table.columns[i].name);
    assert.equal(repetition_type, 'REQUIRED');
    assert.deepEqual({type, converted_type, logical_type}, elements[table.columns[i].type]);
  });
  const pieces = new Map(table.columns.map((column) => [column.name, []]));
  await parquetRead({
    file,
    onChunk: ({columnName, columnData, rowStart}) => pieces.get(columnName).push({rowStart, columnData}),
  });
  assertSameNumbers(
    name,
    [...pieces.values()].map((column) => column.sort((a, b) => a.rowStart - b.rowStart).map(({columnData}) => columnData)),
  );
}

const duckdbTypes = {uint64: 'UBIGINT', int32: 'INTEGER', float64: 'DOUBLE'};
const connection = await (await DuckDBInstance.create(':memory:')).connect();

async function readByDuckdb(name) {
  const table = tables[name];
  const file = `'${parquetFile(name).replaceAll("'", "''")}'`;
  const about = await connection.run(`select created_by, num_rows, num_row_groups from parquet_file_metadata(${file})`);
  assert.deepEqual((await about.getRows())[0], ['ist', BigInt(table.rows), BigInt(table.groups)]);
  const result = await connection.run(`select * from read_parquet(${file})`);
  assert.deepEqual(
    result.columnNames(),
    table.columns.map((column) => column.name),
  );
  assert.deepEqual(
    result.columnTypes().map(String),
    table.columns.map(({type}) => duckdbTypes[type]),
  );
  const chunks = await result.fetchAllChunks();
  assertSameNumbers(
    name,
    table.columns.map((_, i) => chunks.map((chunk) => chunk.getColumnVector(i).items)),
  );
}

for (const name of Object.keys(tables)) {
  test(`hyparquet reads ${name}`, () => readByHyparquet(name));
  test(`DuckDB reads ${name}`, () => readByDuckdb(name));
}
