//! Reads the forces `buoyancy`, `dipoles` and `j2`.

use glam::DVec3;

use super::super::showing::wanted;
use super::super::view::View;
use super::Reader;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::physics::{BodyId, Buoyancy, Dipoles, J2};
use crate::scene::grammar::forces::{buoyancy, dipoles, j2, liquid_surface};
use crate::scene::{Color, ForceKind};

impl Reader<'_, '_> {
    pub(super) fn buoyancy(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let bodies = self.bodies;
        let named = self.named(view).unwrap_or_default();
        let mut carried = Vec::new();
        for id in self.movable(view) {
            let body = &bodies[id.index()];
            if body.shape.submerged(DVec3::Y, 0.0).is_some() {
                carried.push((id, body.shape.clone()));
                continue;
            }
            let span =
                named.iter().find(|(number, _)| *number == id.index()).map_or(self.span, |(_, span)| *span);
            self.not_cut(&body.name, body.shape.name(), span);
        }
        let gravity = self.simulation.gravity;
        if gravity == DVec3::ZERO {
            let name = self.name;
            let message = || format!("the force `{name}` has no effect");
            self.no_effect(message, self.span, "without `simulation.gravity`, nothing is carried");
        }
        let (density, level) = (view.get(&buoyancy::DENSITY)?, view.get(&buoyancy::LEVEL));
        let surface = wanted(view, &buoyancy::SURFACE);
        let surface = surface.map(|surface| surface.get(&liquid_surface::COLOR).unwrap_or(Color::OF_WATER));
        Some(ForceKind::Buoyancy { liquid: Buoyancy { bodies: carried, density, level, gravity }, surface })
    }

    /// Reports a body of a shape for which buoyancy cannot be computed.
    fn not_cut(&mut self, body: &str, shape: &str, span: Span) {
        let message = format!("the surface of the liquid cannot cut `{body}`");
        let why = match shape {
            "mesh" => "its mesh is not closed".to_owned(),
            "axes" => "axes are no solid".to_owned(),
            "box" => "its edges are round".to_owned(),
            shape => format!("its shape, `{shape}`, is not one that is cut"),
        };
        let help = "there are `sphere`, `box` without `rounding`, `cylinder`, `cone`, `capsule`, `torus`, closed meshes, and compounds of these; \
                    with `on`, the force names the bodies that it carries";
        let error = || Diagnostic::error(Code::NoBuoyancy, message).at(span, why).help(help);
        self.report(Code::NoBuoyancy, span, error);
    }

    pub(super) fn dipoles(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let all = self.bodies;
        let field = view.get(&dipoles::FIELD);
        (self.lack, self.softens) = ("it has no `magnetic_moment`", false);
        // With an external magnetic field, the force also acts on a single magnet.
        let alone = field != DVec3::ZERO;
        let is_magnet = |i: usize| all[i].magnetic_moment != DVec3::ZERO;
        let (bodies, against) = self.pairs_or_one(view, 0.0, is_magnet, alone);
        let moments = bodies.iter().chain(against.iter().flatten());
        let moments = moments.map(|body| all[body.index()].magnetic_moment).collect();
        let constant = view.get(&dipoles::CONSTANT);
        Some(ForceKind::Dipoles(Dipoles { bodies, against, moments, constant, field }))
    }

    pub(super) fn j2(&mut self, view: &View<'_>) -> Option<ForceKind> {
        let all = self.bodies;
        let node = view.node(&j2::OF)?;
        let planet = self.body(node)?;
        let usable = |i: usize| i != planet && !all[i].shape.is_unbounded();
        let named = self.named(view);
        let bodies: Vec<usize> = match &named {
            None => (0..all.len()).filter(|&i| usable(i)).collect(),
            Some(named) => {
                for &(body, span) in named.iter().filter(|(body, _)| !usable(*body)) {
                    let why =
                        if body == planet { "it is the planet itself" } else { "a plane has no centre" };
                    self.no_effect(|| format!("the force has no effect on `{}`", all[body].name), span, why);
                }
                named.iter().map(|(body, _)| *body).filter(|&i| usable(i)).collect()
            }
        };
        let moves = |i: &usize| !all[*i].start.fixed;
        if bodies.is_empty() {
            self.acts_on_nothing("it takes a body beside the planet");
        } else if !bodies.iter().any(moves) && all[planet].start.fixed {
            self.acts_on_nothing("all of them are fixed");
        }
        let members: Vec<(usize, Option<Span>)> = bodies.iter().map(|&body| (body, None)).collect();
        self.softens = false;
        self.apart(&[&[(planet, Some(node.span))], &members]);
        Some(ForceKind::J2(J2 {
            planet: BodyId::new(planet),
            bodies: bodies.into_iter().map(BodyId::new).collect(),
            j2: view.get(&j2::J2)?,
            radius: view.get(&j2::RADIUS)?,
            axis: view.get(&j2::AXIS),
            constant: view.get(&j2::CONSTANT),
        }))
    }
}
