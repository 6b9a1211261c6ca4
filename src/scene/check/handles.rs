//! Finds the vectors that a user can drag in the picture.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use crate::diagnostic::{Sources, Span};
use crate::scene::grammar::bodies::body;
use crate::scene::grammar::camera::camera;
use crate::scene::grammar::forces::spring;
use crate::scene::grammar::joints::{ball, rod};
use crate::scene::grammar::lights::point;
use crate::scene::grammar::scene::scene;
use crate::scene::grammar::{Any, Key};
use crate::scene::source::{Node, Value};
use crate::scene::view::View;
use crate::scene::{Body, Handle, HandleKind, HandlePlace};

/// Returns the handles of a scene: locations and velocities of bodies, points of joints, springs, lights and cameras.
///
/// The numbers of a handle belong to one thing alone. So copies made by `repeat` have no handles, and neither do defaults that several bodies
/// share. Vectors of formulas have none either.
pub(super) fn read(root: &View<'_>, bodies: &[Body], sources: &Sources) -> Vec<Handle> {
    let mut handles = Vec::new();
    let mut add = |key: String, node: Option<&Node>| {
        let Some((value, spans)) = node.and_then(|node| vector(node, sources)) else { return };
        let place = HandlePlace::Given(spans);
        handles.push(Handle { key, kind: HandleKind::Point, body: None, value, place });
    };
    for (name, _, table) in root.named(&scene::JOINT).into_iter().filter(|(name, ..)| !is_copy(name)) {
        let Some((kind, joint)) = table.chosen() else { continue };
        if joint.takes(&ball::AT) {
            add(format!("joint.{name}.{kind}.at"), joint.node(&ball::AT));
        }
        if joint.takes(&rod::BETWEEN) {
            ends(&joint, &rod::BETWEEN).for_each(|(end, node)| {
                add(format!("joint.{name}.{kind}.between[{end}]"), Some(node));
            });
        }
    }
    for (name, _, table) in root.named(&scene::FORCE).into_iter().filter(|(name, ..)| !is_copy(name)) {
        let Some(("spring", spring)) = table.chosen() else { continue };
        ends(&spring, &spring::BETWEEN)
            .for_each(|(end, node)| add(format!("force.{name}.spring.between[{end}]"), Some(node)));
    }
    for (name, _, table) in root.named(&scene::LIGHT) {
        let Some((kind, light)) = table.chosen() else { continue };
        if light.takes(&point::LOCATION) {
            add(format!("light.{name}.{kind}.location"), light.node(&point::LOCATION));
        }
    }
    let main = root.table(&scene::CAMERA);
    for key in [&camera::LOCATION, &camera::LOOK_AT] {
        add(format!("camera.{}", key.spec.name), main.node(key));
    }
    handles.extend(of_bodies(root, bodies, sources));
    without_shared(handles, &of_copies(root, sources))
}

/// Leaves out the handles whose numbers are those of another handle or of copies, too.
fn without_shared(mut handles: Vec<Handle>, of_copies: &HashSet<[Span; 3]>) -> Vec<Handle> {
    let given = |handle: &Handle| match handle.place {
        HandlePlace::Given(spans) => Some(spans),
        HandlePlace::Missing(_) => None,
    };
    let mut uses: HashMap<[Span; 3], usize> = HashMap::new();
    for spans in handles.iter().filter_map(given) {
        *uses.entry(spans).or_default() += 1;
    }
    handles
        .retain(|handle| given(handle).is_none_or(|spans| uses[&spans] == 1 && !of_copies.contains(&spans)));
    handles
}

/// Returns where the vectors of copied bodies stand in the text. All copies of a body have the same, so the first is enough.
fn of_copies(root: &View<'_>, sources: &Sources) -> HashSet<[Span; 3]> {
    let is_first = |name: &str| is_copy(name) && name.split('[').skip(1).all(|index| index == "0]");
    let mut found = HashSet::new();
    for table in root.bodies().filter(|table| is_first(table.name())) {
        table.look(|view| {
            let nodes = [&body::LOCATION, &body::VELOCITY].into_iter().filter_map(|key| view.node(key));
            found.extend(nodes.filter_map(|node| Some(vector(node, sources)?.1)));
        });
    }
    found
}

fn of_bodies(root: &View<'_>, bodies: &[Body], sources: &Sources) -> Vec<Handle> {
    let mut handles = Vec::new();
    for (index, (table, body)) in root.bodies().zip(bodies).enumerate() {
        let Some(view) = table.original().filter(|_| body.motion.is_none() && !is_copy(table.name())) else {
            continue;
        };
        let vectors = [
            (&body::LOCATION, HandleKind::Point, body.start.location),
            (&body::VELOCITY, HandleKind::Velocity, body.start.velocity),
        ];
        for (key, kind, value) in vectors {
            if kind == HandleKind::Velocity && body.start.fixed {
                continue;
            }
            let place = match view.node(key) {
                None if value == DVec3::ZERO => HandlePlace::Missing(table.span()),
                Some(node) => match vector(node, sources) {
                    // The copies of a body stand elsewhere than the text says.
                    Some((given, spans)) if given == value => HandlePlace::Given(spans),
                    _ => continue,
                },
                None => continue,
            };
            let key = format!("body.{}.{}", table.name(), key.spec.name);
            handles.push(Handle { key, kind, body: Some(index), value, place });
        }
    }
    handles
}

/// Returns the ends of a joint or a spring, with their numbers.
fn ends<'a>(view: &View<'a>, between: &Key<Any>) -> impl Iterator<Item = (usize, &'a Node)> {
    view.list(between).unwrap_or_default().iter().enumerate()
}

/// Returns whether a name is that of a copy, which has an index: `row[0]`.
fn is_copy(name: &str) -> bool {
    name.contains('[')
}

/// Reads three numbers with their places. `None` if all of them are formulas in the text.
fn vector(node: &Node, sources: &Sources) -> Option<(DVec3, [Span; 3])> {
    let Value::Array(items) = &node.value else { return None };
    let [x, y, z] = &items[..] else { return None };
    let value = DVec3::new(x.as_number()?, y.as_number()?, z.as_number()?);
    let spans = [x.span, y.span, z.span];
    let is_formula = |span: &Span| sources.raw(*span).starts_with(['"', '\'']);
    (!spans.iter().all(is_formula)).then_some((value, spans))
}

#[cfg(test)]
mod tests {
    use crate::Scene;
    use crate::scene::HandlePlace;

    #[test]
    fn a_default_of_several_bodies_has_no_handle() {
        let of = |text: &str| {
            let scene = Scene::parse(&format!("[simulation]\nduration = 1\n{text}")).unwrap();
            scene.handles.into_iter().map(|handle| handle.key).collect::<Vec<_>>()
        };
        let defaults = "[defaults.body]\nlocation = [1, 2, 3]\nvelocity = [1, 0, 0]\n[body.a]\nshape.sphere.radius = 0.1\n";
        assert_eq!(of(defaults), ["body.a.location", "body.a.velocity"]);
        let other = "[body.b]\nshape.sphere.radius = 0.1\nlocation = [5, 0, 0]\n";
        assert_eq!(of(&format!("{defaults}{other}")), ["body.a.location", "body.b.location"]);
        let copied = "[body.row]\nshape.sphere.radius = 0.1\nrepeat = 5\nlocation = [\"5 + i\", 0, 0]\n";
        assert_eq!(of(&format!("{defaults}{copied}")), ["body.a.location"]);
        let lamps = "[body.a]\nshape.sphere.radius = 0.1\nvelocity = [1, 0, 0]\nlocation = [1, 0, 0]\n\
                     [defaults.light]\npoint.location = [1, 5, 0]\n[light.one]\ncolor = 'red'\n[light.two]\ncolor = 'blue'\n";
        assert_eq!(of(lamps), ["body.a.location", "body.a.velocity"]);
    }

    #[test]
    fn handles_are_vectors_that_stand_in_the_text_as_they_are() {
        let text = r#"
[simulation]
duration = 1

[body.ball]
shape.sphere.radius = 0.1
location = [0, "1 + 1", 3]

[body.row]
shape.sphere.radius = 0.1
location = [5, 0, 0]
repeat.grid = { count = [2, 1, 1], spacing = [1, 1, 1] }

[body.wall]
shape.box.size = [1, 1, 1]
location = [9, 0, 0]
fixed = true

[body.wheel]
shape.sphere.radius = 0.1
motion.formula.location = ["20 + t", 0, 0]

[joint.rod]
rod.between = ["ball", [0, 5, 0]]

[joint.formulas]
rod.between = ["ball", ["1", "2", "3"]]

[joint.door]
hinge = { between = ["wall", "ball"], at = [1, 2, 3], axis = [0, 0, 1] }

[force.spring]
spring = { between = [[7, 7, 7], "ball"], stiffness = 1 }

[light.lamp]
point.location = ["t", 5, 5]

[camera]
location = [0, 1, 20]
"#;
        let scene = Scene::parse(text).unwrap();
        let sources = &scene.warnings.sources;
        let found: Vec<String> = scene
            .handles
            .iter()
            .map(|handle| {
                let given = match handle.place {
                    HandlePlace::Given(spans) => spans.map(|span| sources.raw(span)).join(" "),
                    HandlePlace::Missing(name) => format!("missing in {}", sources.raw(name)),
                };
                format!("{} {:?} {}: {given}", handle.key, handle.kind, handle.value)
            })
            .collect();
        insta::assert_snapshot!(found.join("\n"), @r#"
        joint.rod.rod.between[1] Point [0, 5, 0]: 0 5 0
        joint.door.hinge.at Point [1, 2, 3]: 1 2 3
        force.spring.spring.between[0] Point [7, 7, 7]: 7 7 7
        camera.location Point [0, 1, 20]: 0 1 20
        body.ball.location Point [0, 2, 3]: 0 "1 + 1" 3
        body.ball.velocity Velocity [0, -0, 0]: missing in ball
        body.wall.location Point [9, 0, 0]: 9 0 0
        "#);
    }
}
