//! Which objects of a scene glow.
//!
//! A node that has a halo has it with all that hangs on it, unless something of that is switched by itself.

use std::collections::BTreeMap;

use super::Scene;

impl Scene {
    /// Of each node, whether it glows.
    #[must_use]
    pub fn glowing_nodes(&self, edits: &BTreeMap<usize, bool>) -> Vec<bool> {
        let mut glows = Vec::with_capacity(self.nodes.len());
        self.append_glowing_nodes(edits, &mut glows);
        glows
    }

    fn append_glowing_nodes(&self, edits: &BTreeMap<usize, bool>, glows: &mut Vec<bool>) {
        for (index, node) in self.nodes.iter().enumerate() {
            let with_parent = node.parent.and_then(|parent| glows.get(parent)).copied();
            glows.push(edits.get(&index).copied().unwrap_or(node.halo || with_parent == Some(true)));
        }
    }

    /// Of each instance, whether it glows.
    #[must_use]
    pub fn glowing(&self, edits: &BTreeMap<usize, bool>) -> Vec<bool> {
        let mut glows = Vec::new();
        self.find_glowing(edits, &mut glows);
        glows
    }

    /// The same, into `glows`, whose memory is used.
    pub fn find_glowing(&self, edits: &BTreeMap<usize, bool>, glows: &mut Vec<bool>) {
        glows.clear();
        self.append_glowing_nodes(edits, glows);
        let mut instances = 0;
        for (node, ..) in self.instances() {
            // No instance comes before its node.
            glows[instances] = glows[node];
            instances += 1;
        }
        glows.truncate(instances);
    }

    /// Gives a node a halo, or takes it away, with all that hangs on it.
    pub fn set_halo(&self, edits: &mut BTreeMap<usize, bool>, node: usize, on: bool) {
        let hangs_on = |mut at: usize| loop {
            match self.nodes.get(at).and_then(|node| node.parent) {
                Some(parent) if parent == node => return true,
                Some(parent) => at = parent,
                None => return false,
            }
        };
        edits.retain(|other, _| *other != node && !hangs_on(*other));
        if self.glowing_nodes(edits).get(node) != Some(&on) {
            edits.insert(node, on);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Node;

    #[test]
    fn what_hangs_on_a_node_glows_with_it_until_it_is_switched_by_itself() {
        let node = |parent, halo| Node { parent, halo, ..Node::default() };
        let nodes = vec![node(None, false), node(Some(0), false), node(Some(1), false), node(None, true)];
        let scene = Scene { nodes, ..Scene::default() };
        let mut edits = BTreeMap::new();
        assert_eq!(scene.glowing_nodes(&edits), [false, false, false, true]);
        scene.set_halo(&mut edits, 0, true);
        assert_eq!(scene.glowing_nodes(&edits), [true, true, true, true]);
        scene.set_halo(&mut edits, 2, false);
        assert_eq!(scene.glowing_nodes(&edits), [true, true, false, true]);
        scene.set_halo(&mut edits, 1, true);
        assert_eq!(edits, [(0, true)].into(), "what is as it would be anyway is not kept");
        scene.set_halo(&mut edits, 3, false);
        scene.set_halo(&mut edits, 3, true);
        scene.set_halo(&mut edits, 0, false);
        assert_eq!(edits, BTreeMap::new());
    }
}
