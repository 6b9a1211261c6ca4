// What a plot shows, as a table of comma-separated values (CSV).

/**
 * Returns a table of curves: a column of times, then one for each curve. Each number is the shortest one that reads back the same. Where a curve
 * has no value, its cell is empty. `columns` are curves with a heading.
 */
export function tableOf(timeHeading, columns) {
  const times = mergedTimes(columns.map(({ times }) => times));
  const next = columns.map(() => 0);
  const rows = times.map((time) => {
    const cells = columns.map(({ times, values }, k) => {
      const isThere = times[next[k]] === time;
      const value = isThere ? values[next[k]++] : NaN;
      return Number.isNaN(value) ? "" : String(value);
    });
    return [String(time), ...cells].join(",");
  });
  const headings = [timeHeading, ...columns.map(({ heading }) => heading)];
  return `${[headings.map(quoted).join(","), ...rows].join("\n")}\n`;
}

/** Returns the times of all curves, each once. */
function mergedTimes(all) {
  const different = all.filter((times, k) => !all.slice(0, k).some((other) => same(times, other)));
  if (different.length === 1) return Array.from(different[0]);
  return [...new Set(different.flatMap((times) => Array.from(times)))].sort((a, b) => a - b);
}

const same = (a, b) => a === b || (a.length === b.length && a.every((time, k) => time === b[k]));
const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
