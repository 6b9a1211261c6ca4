//! Tests reading of intact and damaged mesh files.

use std::fs;

use super::*;

/// An OBJ file of a tetrahedron with the volume 1/6.
const OBJ_TEXT: &str = "# a corner of a cube
mtllib none.mtl
o corner
v 0 0 0
v 1 0 0 # the second
v 0 1 0 0.5 0.5 0.5
v 0 0 1 1.0
vt 0 0
vn 0 0 1
usemtl missing
s off
f 1/1/1 3/1/1 2/1/1
g caf\u{e9}
f -4//1 -3//1 -1//1
f 2/9 3/9/99 4
l 1 2
p 1
f 3 1 4
";

/// The same tetrahedron as a text STL file that is divided into two solids.
const STL_TEXT: &str = "
SOLID
 facet normal 0 0 -1
  outer loop
   vertex 0 0 0
   vertex 0 1 0
   vertex 1 0 0
  endloop
 endfacet
 facet normal 0 -1 0
  outer loop
   vertex 0 0 0
   vertex 1 0 0
   vertex 0 0 1
  endloop
 endfacet
endsolid
solid other half
 facet normal 1 1 1
  outer loop
   vertex 1 0 0
   vertex -0 1 0
   vertex 0 0 1
  endloop
 endfacet
 facet normal -1 0 0
  outer loop
   vertex 0 1 0
   vertex 0 0 0
   vertex 0 0 1
  endloop
 endfacet
endsolid other half
";

fn binary_stl() -> Vec<u8> {
    let mut bytes = b"solid in name only".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    let corners: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for triangle in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flat_map(|&i: &usize| corners[i]).flat_map(f32::to_le_bytes));
        bytes.extend([0; 2]);
    }
    bytes
}

/// Breaks each line that has vertices or faces after each of its words.
fn continued(text: &str, with: &str) -> String {
    let line = |line: &str| match line.trim_start().starts_with(['v', 'f']) {
        true => line.split_whitespace().collect::<Vec<_>>().join(&format!(" {with}")) + "\n",
        false => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// Puts a byte-order mark before a text.
fn marked(text: &str) -> Vec<u8> {
    format!("\u{feff}{text}").into_bytes()
}

#[test]
fn an_error_in_a_continued_line_names_its_first_line() {
    let text = "# A corner.\nv 0 \\\n0 0\nv 1 0 0\nv 0 \\\n1 \\\nx\nv 0 0 1\n";
    assert_eq!(why("corner.obj", text.as_bytes()), "line 5: a vertex is `v x y z`, in numbers");
}

fn read_bytes(name: &str, bytes: &[u8]) -> Result<Mesh, MeshError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read(&path)
}

fn why(name: &str, bytes: &[u8]) -> String {
    read_bytes(name, bytes).unwrap_err().to_string()
}

#[test]
fn every_format_gives_the_same_solid() {
    let files = [
        ("corner.OBJ", OBJ_TEXT.as_bytes().to_vec()),
        ("corner.obj", OBJ_TEXT.replace('\n', "\r\n").into_bytes()),
        ("corner.obj", OBJ_TEXT.bytes().map(|byte| if byte > 127 { 0xe9 } else { byte }).collect()),
        ("corner.obj", continued(OBJ_TEXT, "\\\n").into_bytes()),
        ("corner.obj", continued(OBJ_TEXT, " \\\r\n\t").into_bytes()),
        ("corner.obj", OBJ_TEXT.replace('\n', " \\\n\n").into_bytes()),
        ("corner.obj", marked(OBJ_TEXT.trim_start())),
        ("corner.obj", format!("# C:\\models\\\n{OBJ_TEXT}\n# the end \\").into_bytes()),
        ("corner.obj", format!("{}\\\n\\", OBJ_TEXT.trim_end()).into_bytes()),
        ("corner.stl", marked(STL_TEXT.trim_start())),
        ("corner.stl", marked(STL_TEXT)),
        ("corner.stl", STL_TEXT.into()),
        ("corner.stl", STL_TEXT.trim_start().to_lowercase().into_bytes()),
        ("corner.Stl", binary_stl()),
    ];
    for (name, bytes) in files {
        let mesh = read_bytes(name, &bytes).unwrap();
        assert_eq!((mesh.name(), mesh.flaw()), ("corner", None), "{name}");
        assert_eq!((mesh.vertices().len(), mesh.triangles().len()), (4, 4), "{name}");
        let volume = crate::physics::Shape::Mesh { mesh: mesh.into(), scale: 1.0 }.volume().unwrap();
        assert!((volume - 1.0 / 6.0).abs() < 1e-15, "{name}: {volume}");
    }
}

#[test]
fn polygons_are_cut_and_seams_closed() {
    let mut cube = String::new();
    // Each face of the cube has its own vertices, as in files from programs that split surfaces at the seams of textures.
    for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
        for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            let mut corner = [side; 3];
            (corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (u, v);
            cube += &format!("v {} {} {}\n", corner[0], corner[1], corner[2]);
        }
        cube += if side == 1 { "f -4 -3 -2 -1\n" } else { "f -1 -2 -3 -4\n" };
    }
    let mesh = read_bytes("cube.obj", cube.as_bytes()).unwrap();
    assert_eq!((mesh.flaw(), mesh.vertices().len(), mesh.triangles().len()), (None, 8, 12));
}

#[test]
fn what_cannot_be_read_says_why_and_where() {
    let obj = |text: &str| why("x.obj", text.as_bytes());
    assert_eq!(obj("v 0 0 0\nv 1 0\n"), "line 2: a vertex is `v x y z`, in numbers");
    assert_eq!(obj("v 0 0 0\n\nv 0,5 0 0\n"), "line 3: a vertex is `v x y z`, in numbers");
    assert_eq!(obj("v 0 0 0\nf 1 one 1\n"), "line 2: a face is `f` and the numbers of its vertices");
    assert_eq!(obj("v 0 0 0\nf 1 2 3\n"), "a face names a vertex that is not there");
    assert_eq!(obj("v 0 0 0\nf 0 1 1\n"), "a face names a vertex that is not there");
    assert_eq!(obj("v 0 0 0\nf 1 1 1\n"), "it has no triangles");
    assert_eq!(obj(""), "it has no triangles");
    assert_eq!(obj("\u{feff}\u{feff}\\\n"), "it has no triangles");
    assert_eq!(obj("v nan 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3"), "a vertex is at [NaN, 0, 0]");
    assert_eq!(obj("v 1e60 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3").split(" at ").next(), Some("a vertex is"));
    let huge = format!("v 0 0 0\nf 1{}\n", " 1".repeat(9_000_000));
    assert_eq!(obj(&huge), "line 2: it is no text");

    let stl = |bytes: &[u8]| why("x.stl", bytes);
    let broken = STL_TEXT.replace("vertex 0 0 1", "vertex 0 0 one");
    assert!(stl(broken.as_bytes()).starts_with("line 14: "), "{}", stl(broken.as_bytes()));
    let cut = &STL_TEXT.as_bytes()[..STL_TEXT.len() - 25];
    assert!(stl(cut).starts_with("line 32: "), "{}", stl(cut));
    assert_eq!(stl(&binary_stl()[..200]), "it is cut off: it has 2 of 4 triangles");
    assert_eq!(stl(b"hello"), "it is too short for a binary STL, and does not begin with `solid`");
    assert_eq!(why("x.ply", b"ply"), "its name ends neither with `.obj` nor with `.stl`");
}

/// Reading a truncated or changed file returns a mesh or an error, and never panics.
#[test]
fn broken_files_are_no_reason_to_panic() {
    let files = [("x.obj", OBJ_TEXT.into()), ("x.stl", STL_TEXT.into()), ("x.stl", binary_stl())];
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in &files {
        let path = folder.path().join(name);
        let bytes: &Vec<u8> = bytes;
        for length in 0..bytes.len() {
            fs::write(&path, &bytes[..length]).unwrap();
            let _ = read(&path);
        }
        for (i, other) in (0..bytes.len()).step_by(3).flat_map(|i| b"\0-9/ \n\xff".map(|other| (i, other))) {
            let mut bytes = bytes.clone();
            bytes[i] = other;
            fs::write(&path, bytes).unwrap();
            let _ = read(&path);
        }
    }
}

/// Writes a PNG file from the given pixel bytes.
fn image(path: &Path, width: u32, depth: png::BitDepth, color: png::ColorType, bytes: &[u8]) {
    let bits = width as usize * color.samples() * depth as usize;
    let rows = bytes.len() / bits.div_ceil(8);
    let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), width, rows as u32);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
}

#[test]
fn pixels_are_the_heights_at_their_places() {
    use png::{BitDepth, ColorType};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hills.png");
    let size = DVec3::new(4.0, 2.0, 6.0);
    image(&path, 3, BitDepth::Eight, ColorType::Grayscale, &[0, 51, 255, 0, 0, 0]);
    let mesh = heightfield(&path, size).unwrap();
    let expected = [[-2.0, 0.0, -3.0], [0.0, 0.4, -3.0], [2.0, 2.0, -3.0], [-2.0, 0.0, 3.0]];
    for (vertex, expected) in mesh.vertices().iter().zip(expected) {
        assert!(vertex.abs_diff_eq(DVec3::from_array(expected), 1e-15), "{vertex}");
    }
    let up = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|vertex| mesh.vertices()[vertex as usize]);
        (b - a).cross(c - a).y > 0.0
    };
    assert!(mesh.triangles().len() == 4 && mesh.triangles().iter().all(up));

    let highest = |mesh: Mesh| mesh.vertices().iter().map(|vertex| vertex.y).fold(f64::MIN, f64::max);
    image(&path, 2, BitDepth::Sixteen, ColorType::Grayscale, &[0, 1, 0, 0, 0, 0, 0, 0]);
    assert!((highest(heightfield(&path, size).unwrap()) - 2.0 / 65535.0).abs() < 1e-9);
    image(&path, 2, BitDepth::Eight, ColorType::Rgba, &[0, 255, 0, 0, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert!((highest(heightfield(&path, size).unwrap()) - 2.0 * 0.7152).abs() < 1e-6);
    image(&path, 2, BitDepth::One, ColorType::Grayscale, &[0b1000_0000]);
    assert_eq!(
        heightfield(&path, size).unwrap_err().to_string(),
        "2 × 1 pixels make no surface: 2 × 2 are the least"
    );
    fs::write(&path, "P2").unwrap();
    assert!(heightfield(&path, size).unwrap_err().to_string().starts_with("it is no PNG: "));
}
