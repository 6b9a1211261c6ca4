/** The files of the fonts of texts, regular and bold. The page shows texts in them, and jabuka measures texts by them. */
export const FONTS = ["DejaVuSans.ttf", "DejaVuSans-Bold.ttf"];
