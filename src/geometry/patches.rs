//! Triangles seen edge-on, and how they are decided: by their neighbours, from those next to the light on.
//!
//! One that is seen edge-on counts where all its neighbours count that lie on its side towards the light; one that has
//! none there does not. A neighbour may be edge-on itself, so what it decides is passed on. Nothing counts until a
//! neighbour says so, hence the outcome is the same in whatever order they are asked: the least that satisfies all of them.

use std::collections::VecDeque;

use glam::{Vec3, Vec4};

use super::Topology;
use super::silhouette::Planes;
use super::topology::directed_edges;

/// Memory that flat patches are decided in, kept from one light to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Patches {
    edge_on: Vec<u32>,
    /// The neighbour across an edge on a triangle's side towards the light, and the triangle, by its place in `edge_on`.
    followed: Vec<(u32, u32)>,
    /// Of each of `edge_on`, how many of those do not count yet.
    waits_for: Vec<u32>,
    decided: VecDeque<u32>,
}

impl Patches {
    /// Decides the triangles `edge_on` (by growing number), none of which counts yet.
    pub fn follow_neighbours(
        &mut self,
        topology: &Topology,
        planes: &Planes,
        welded: &[Vec3],
        light: Vec4,
        edge_on: impl Iterator<Item = u32>,
        contributions: &mut [i8],
    ) {
        self.edge_on.clear();
        self.edge_on.extend(edge_on);
        self.followed.clear();
        self.waits_for.clear();
        self.decided.clear();
        let pairs = topology.pairs();
        for (place, &triangle) in (0u32..).zip(&self.edge_on) {
            let mut waits_for = 0;
            let mut follows = false;
            for [from, to] in directed_edges(&topology.triangles()[triangle as usize]) {
                let Some(edge) = pairs.between(from, to) else { continue };
                let neighbour = if from < to { pairs.backward[edge] } else { pairs.forward[edge] };
                let [a, b] = [from, to].map(|vertex| welded[vertex as usize].as_dvec3());
                let outward = (b - a).cross(planes.normal(triangle as usize).as_dvec3());
                let light = light.as_dvec4();
                if outward.dot(light.truncate() - a * light.w) > 0.0 {
                    follows = true;
                    if contributions[neighbour as usize] != 1 {
                        waits_for += 1;
                        self.followed.push((neighbour, place));
                    }
                }
            }
            self.waits_for.push(waits_for);
            if follows && waits_for == 0 {
                self.decided.push_back(triangle);
            }
        }
        self.followed.sort_unstable();
        while let Some(triangle) = self.decided.pop_front() {
            contributions[triangle as usize] = 1;
            let first = self.followed.partition_point(|(neighbour, _)| *neighbour < triangle);
            for &(_, place) in self.followed[first..].iter().take_while(|(neighbour, _)| *neighbour == triangle) {
                self.waits_for[place as usize] -= 1;
                if self.waits_for[place as usize] == 0 {
                    self.decided.push_back(self.edge_on[place as usize]);
                }
            }
        }
    }
}
