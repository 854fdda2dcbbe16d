"use strict";
// What is packed inside the page, and files that the page hands out. No request leaves it.
{
  report.bytes = (text) => {
    if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
    const letters = atob(text), bytes = new Uint8Array(letters.length);
    for (let k = 0; k < bytes.length; k++) bytes[k] = letters.charCodeAt(k);
    return bytes;
  };

  // Fails where the browser has no DecompressionStream (those of before 2023).
  report.unpacked = async (text) => {
    const { readable, writable } = new DecompressionStream("deflate"), writer = writable.getWriter();
    const sent = writer.write(report.bytes(text)).then(() => writer.close());
    const [bytes] = await Promise.all([new Response(readable).arrayBuffer(), sent]);
    return new Uint8Array(bytes);
  };

  report.save = (name, type, content) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([content], { type: `${type};charset=utf-8` }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  };

  // As report/tables.py has it: no cell that a spreadsheet would compute.
  report.harmless = (cell) => (/^[='+\-@\t\r\n＝＋－＠]/.test(cell) && Number.isNaN(Number(cell)) ? `'${cell}` : cell);

  // Pictures of the paper's page are inside it: their copies are made from it.
  document.addEventListener("click", async (event) => {
    const link = event.target.closest?.("a[data-copy]");
    if (!link) return;
    const figure = link.closest("figure"), name = link.getAttribute("href").split("/").pop();
    const image = figure.querySelector("img"), numbers = figure.querySelector("script");
    const svg = link.dataset.copy === "svg" && image?.src.startsWith("data:");
    const csv = link.dataset.copy === "csv" && numbers && typeof DecompressionStream !== "undefined";
    if (!svg && !csv) return; // then the link leads to the file
    event.preventDefault();
    if (svg) report.save(name, "image/svg+xml", decodeURIComponent(image.src.slice(image.src.indexOf(",") + 1)));
    else report.save(name, "text/csv", await report.unpacked(numbers.textContent));
  });

  // A workbook is a zip of a few small files: stored, not compressed.
  const CHECK = Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n >>> 0;
  });
  function zipped(files) {
    const parts = [], directory = [];
    let at = 0;
    for (const [name, text] of files) {
      const bytes = new TextEncoder().encode(text), path = new TextEncoder().encode(name);
      const check = bytes.reduce((sum, byte) => CHECK[(sum ^ byte) & 255] ^ (sum >>> 8), 0xffffffff) ^ 0xffffffff;
      const head = new DataView(new ArrayBuffer(46)); // of the directory; the file's own lacks some of it
      const fields = [[0, 0x02014b50, 4], [4, 20, 2], [6, 20, 2], [8, 0x800, 2], [14, 0x21, 2], [16, check >>> 0, 4], [20, bytes.length, 4], [24, bytes.length, 4], [28, path.length, 2], [42, at, 4]];
      for (const [place, value, size] of fields) size === 4 ? head.setUint32(place, value, true) : head.setUint16(place, value, true);
      const own = new Uint8Array(30);
      own.set([0x50, 0x4b, 3, 4]);
      own.set(new Uint8Array(head.buffer, 6, 26), 4);
      parts.push(own, path, bytes);
      directory.push(new Uint8Array(head.buffer), path);
      at += 30 + path.length + bytes.length;
    }
    const size = directory.reduce((sum, part) => sum + part.length, 0), end = new DataView(new ArrayBuffer(22));
    end.setUint32(0, 0x06054b50, true);
    end.setUint16(8, files.length, true);
    end.setUint16(10, files.length, true);
    end.setUint32(12, size, true);
    end.setUint32(16, at, true);
    return new Blob([...parts, ...directory, end]);
  }

  // Rows of texts and numbers as a workbook of one sheet.
  report.workbook = (rows) => {
    const escape = (text) => String(text).replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f]/g, "").replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);
    const cell = (value) => (typeof value === "number" ? `<c><v>${value}</v></c>` : `<c t="inlineStr"><is><t xml:space="preserve">${escape(value)}</t></is></c>`);
    const xml = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n';
    const office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships", pack = "http://schemas.openxmlformats.org/package/2006";
    const main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main", kind = "application/vnd.openxmlformats-officedocument.spreadsheetml";
    return zipped([
      ["[Content_Types].xml", `${xml}<Types xmlns="${pack}/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Override PartName="/xl/workbook.xml" ContentType="${kind}.sheet.main+xml"/><Override PartName="/xl/worksheets/sheet1.xml" ContentType="${kind}.worksheet+xml"/></Types>`],
      ["_rels/.rels", `${xml}<Relationships xmlns="${pack}/relationships"><Relationship Id="a" Type="${office}/officeDocument" Target="xl/workbook.xml"/></Relationships>`],
      ["xl/workbook.xml", `${xml}<workbook xmlns="${main}" xmlns:r="${office}"><sheets><sheet name="table" sheetId="1" r:id="a"/></sheets></workbook>`],
      ["xl/_rels/workbook.xml.rels", `${xml}<Relationships xmlns="${pack}/relationships"><Relationship Id="a" Type="${office}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>`],
      ["xl/worksheets/sheet1.xml", `${xml}<worksheet xmlns="${main}"><sheetData>${rows.map((row) => `<row>${row.map(cell).join("")}</row>`).join("")}</sheetData></worksheet>`],
    ]);
  };

  // The details of a run are unpacked when it is opened, with those of the runs compressed together with it.
  report.unfold = async (details) => {
    const part = Number(details.dataset.part ?? 0), first = part ? document.getElementById(`run-${details.id.slice(4) - part}`) : details;
    const packed = first.querySelector(":scope > script.packed");
    if (!packed || details.unfolded) return;
    details.unfolded = true;
    const place = document.createElement("div");
    try {
      packed.parts ??= report.unpacked(packed.textContent).then((bytes) => new TextDecoder().decode(bytes).split("<!--next run-->"));
      place.innerHTML = (await packed.parts)[part];
    } catch {
      place.textContent = "This browser cannot show the details of a run; the numbers are in report.json and tables/.";
    }
    details.append(place);
    report.dress?.(place);
    report.charts?.watch(place);
    report.reviewing?.join(details);
  };
}
