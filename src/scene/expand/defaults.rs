//! Fills in the missing keys of bodies, materials, lights and forces from the scene's `[defaults]` table.

use std::collections::HashSet;

use super::Expander;
use super::merge::merge;
use crate::diagnostic::Span;
use crate::scene::grammar::{Kind, SCENE};
use crate::scene::source::{Node, Table, Value};

impl Expander<'_> {
    /// Fills in the missing keys of every body, material, light, force and so on from the scene's `[defaults]` table.
    pub(super) fn defaults(&mut self, root: &mut Table) {
        let Some(Value::Table(defaults)) = root.get("defaults").map(|entry| &entry.node.value) else {
            return;
        };
        for default in defaults.clone().entries {
            let Value::Table(base) = &default.node.value else { continue };
            let Some(Kind::Named(spec)) = SCENE.key(&default.name.text).map(|key| &key.kind) else {
                continue;
            };
            places(&default.node, &mut self.of_defaults);
            let things = root.get_mut(&default.name.text).map(|entry| &mut entry.node.value);
            let Some(Value::Table(things)) = things else { continue };
            for thing in &mut things.entries {
                if let Value::Table(own) = &mut thing.node.value {
                    merge(own, base, spec);
                }
            }
        }
    }
}

/// Collects the source spans of all keys and values below a node.
fn places(node: &Node, into: &mut HashSet<Span>) {
    into.insert(node.span);
    match &node.value {
        Value::Table(table) => {
            for entry in &table.entries {
                into.insert(entry.name.span);
                places(&entry.node, into);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| places(item, into)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::physics::Shape;
    use crate::scene::{Finish, ForceKind, LightKind, Look, Scene};

    fn scene(text: &str) -> Scene {
        let scene = Scene::parse(text).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(scene.warnings.diagnostics.len(), 0, "{}", scene.warnings);
        scene
    }

    #[test]
    fn what_a_body_says_itself_counts() {
        let scene = scene(
            "[defaults.body]\nshape.sphere.radius = 2\nmass = 3\nvelocity = [1, 0, 0]\nlook.scale = 2\n\
             [body.a]\n[body.b]\nmass = 5\nlook.sdl_before = 'no_shadow'\n[body.c]\nshape.sphere = {}\n\
             velocity = [0, 0, 0]\n",
        );
        let starts = |of: &dyn Fn(&crate::physics::RigidBody) -> f64| {
            scene.bodies.iter().map(|body| of(&body.start)).collect::<Vec<_>>()
        };
        assert_eq!(starts(&|start| start.mass), [3.0, 5.0, 3.0]);
        assert_eq!(starts(&|start| start.velocity.x), [1.0, 1.0, 0.0]);
        assert!(scene.bodies.iter().all(|body| body.shape == Shape::Sphere { radius: 2.0 }));
        // Missing keys of nested tables such as `look` are filled in one by one.
        assert_eq!((scene.bodies[1].look.scale, scene.bodies[1].look.sdl_before.is_some()), (2.0, true));
    }

    #[test]
    fn what_a_body_says_replaces_what_cannot_stand_beside_it() {
        let scene = scene(
            "[defaults.body]\nshape.sphere.radius = 2\nmass = 3\norientation = [0, 90, 0]\n\
             [body.a]\nshape.box.size = [1, 2, 3]\ndensity = 2\norientation.euler = [0, 0, 0]\n",
        );
        assert_eq!(scene.bodies[0].shape, Shape::Box { size: DVec3::new(1.0, 2.0, 3.0) });
        assert_eq!(scene.bodies[0].start.mass, 12.0);
        assert_eq!(scene.bodies[0].start.orientation, glam::DQuat::IDENTITY);
    }

    #[test]
    fn materials_lights_and_forces_have_defaults_too() {
        let scene = scene(
            "[defaults]\nmaterial = { finish = 'metal' }\nlight = { intensity = 0.5, point.location = [0, 9, 0] }\n\
             force.spring = { stiffness = 7 }\n\
             [material.gold]\ncolor = 'gold'\n[material.chrome]\ncolor = 'red'\nfinish = 'matte'\n\
             [light.lamp]\n[light.sun]\nsun.direction = [0, -1, 0]\n\
             [force.s]\nspring.between = ['a', [0, 5, 0]]\n[force.d]\ndrag.linear = 1\n\
             [body.a]\nshape.sphere.radius = 1\nmaterial = 'gold'\n",
        );
        let finish = |n: usize| match &scene.materials[n].look {
            Look::Plain { finish, .. } => *finish,
            other => panic!("{other:?}"),
        };
        assert_eq!((finish(0), finish(1)), (Finish::Metal, Finish::Matte));
        assert!(scene.lights.iter().all(|light| light.intensity == 0.5));
        assert!(matches!(scene.lights[0].kind, LightKind::Point { .. }));
        assert!(matches!(scene.lights[1].kind, LightKind::Sun { .. }));
        assert!(
            matches!(&scene.forces[0].kind, ForceKind::Spring { links, .. } if links[0].stiffness == 7.0)
        );
        assert!(matches!(scene.forces[1].kind, ForceKind::OnEach(_)));
    }

    #[test]
    fn a_formula_of_the_defaults_is_evaluated_for_each_body() {
        let scene = scene(
            "[defaults.body]\nshape.sphere.radius = 'r'\nmass = 'uniform(1, 2)'\n[variables]\nr = 0.5\n\
             [body.a]\n[body.b]\nlocation = [3, 0, 0]\n[body.c]\nlocation = [0, '2*i + 2', 0]\nrepeat = 2\n",
        );
        let masses: Vec<f64> = scene.bodies.iter().map(|body| body.start.mass).collect();
        assert!(masses[0] != masses[1] && masses[2] != masses[3], "{masses:?}");
        // A body draws the same random numbers for a formula from `[defaults]` as for a formula of its own.
        let alone = Scene::parse("[body.b]\nshape.sphere.radius = 0.5\nmass = 'uniform(1, 2)'").unwrap();
        assert_eq!(alone.bodies[0].start.mass, masses[1]);
    }

    #[test]
    fn defaults_without_effect_on_some_are_no_mistake() {
        let scene = scene(
            "[defaults.body]\nmass = 3\nmaterial = 'steel'\n[body.floor]\nshape.plane.normal = [0, 1, 0]\n\
             [body.axes]\nshape.axes.length = 1\nlocation = [0, 2, 0]\n",
        );
        assert_eq!(scene.bodies.len(), 2);
    }
}
