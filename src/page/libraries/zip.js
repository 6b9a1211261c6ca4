// What the page uses of fflate to make zip files.

export { Zip, ZipDeflate } from "fflate";
