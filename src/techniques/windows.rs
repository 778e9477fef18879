//! Windows: the blocks of the picture's cells that a light's volumes are counted in, each with the volumes that matter
//! there.
//!
//! A volume matters in the cells where its shadow may fall ([`crate::geometry::footprint`]), so the least work would be
//! done by a call for each cell, with that cell for its scissor and its volumes alone. But calls cost, and so does every
//! triangle that is set up once more for another cell. So neighbours are joined into one window where that is cheaper,
//! along rows first, then rows of the same columns; and where one window about all is the cheapest, there is one.
//!
//! Windows of a count do not overlap, and whatever is counted in a window is counted there with all its parts: each
//! count is whole in every pixel it touches.

use super::workspace::{Lent, Workspace};
use crate::geometry::pixels::{Grid, common};

/// What a call costs a software GPU, in fragments of volumes.
const CALL: u64 = 10_000;

/// And what a triangle costs it that it meets once more.
const TRIANGLE: u64 = 300;

/// Of so many pixels of its rectangle a volume has about one fragment.
const SPARSE: u64 = 3;

/// A volume, as far as windows are concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Footprint {
    /// The cells it matters in.
    pub cells: u64,
    /// The pixels it is drawn in.
    pub rect: [u32; 4],
    /// About how many triangles it has.
    pub triangles: u64,
}

impl Footprint {
    /// A volume drawn in `rect` whose caster has so many triangles: its silhouette grows as their root, seven edges long
    /// where that is one (measured on knots of 6,000 and 200,000 triangles), and never holds more than all edges.
    #[must_use]
    pub fn of(cells: u64, rect: [u32; 4], triangles: usize) -> Self {
        let triangles = triangles as u64;
        Self { cells, rect, triangles: triangles.min(14 * triangles.isqrt()) }
    }
}

/// Some cells, as one rectangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Column, row, columns, rows.
    block: [u32; 4],
    /// Its cells.
    pub cells: u64,
    /// Its pixels.
    pub rect: [u32; 4],
    cost: u64,
}

/// The windows to count these volumes in.
#[must_use]
pub fn windows<'w>(footprints: &[Footprint], grid: Grid, workspace: &'w Workspace) -> Lent<'w, Window> {
    let window = |block: [u32; 4]| {
        let (cells, rect) = (grid.block(block), grid.pixels(block));
        let area = |[_, _, width, height]: [u32; 4]| u64::from(width) * u64::from(height);
        let of_volume = |volume: &Footprint| TRIANGLE * volume.triangles + common(volume.rect, rect).map_or(0, area) / SPARSE;
        let cost = footprints.iter().filter(|volume| volume.cells & cells != 0).map(of_volume).sum::<u64>();
        Window { block, cells, rect, cost: if cost == 0 { 0 } else { CALL + cost } }
    };
    let mut found = workspace.windows.lend();
    let all = footprints.iter().fold(0, |cells, volume| cells | volume.cells);
    let [across, down] = grid.cells();
    // Rows: neighbours are joined where that costs no more.
    for row in 0..down {
        let mut last: Option<Window> = None;
        for column in 0..across {
            let next = window([column, row, 1, 1]);
            if next.cells & all == 0 {
                found.extend(last.take());
                continue;
            }
            last = match last {
                None => Some(next),
                Some(before) => {
                    let both = window([before.block[0], row, before.block[2] + 1, 1]);
                    if both.cost <= before.cost + next.cost {
                        Some(both)
                    } else {
                        found.push(before);
                        Some(next)
                    }
                }
            };
        }
        found.extend(last);
    }
    // Then whole windows of one row with those below them of the same columns.
    let mut at = 0;
    while at < found.len() {
        let [column, row, columns, rows] = found[at].block;
        let below = found.iter().position(|other| other.block == [column, row + rows, columns, other.block[3]]);
        let joined = below.map(|below| (below, window([column, row, columns, rows + found[below].block[3]])));
        match joined {
            Some((below, both)) if both.cost <= found[at].cost + found[below].cost => {
                found[at] = both;
                found.remove(below);
            }
            _ => at += 1,
        }
    }
    let apart = found.iter().map(|window| window.cost).sum::<u64>();
    let bounds = found.iter().map(|window| window.block).reduce(|[ax, ay, aw, ah], [bx, by, bw, bh]| {
        let (x, y) = (ax.min(bx), ay.min(by));
        [x, y, (ax + aw).max(bx + bw) - x, (ay + ah).max(by + bh) - y]
    });
    if let Some(whole) = bounds.map(window).filter(|whole| whole.cost <= apart) {
        found.clear();
        found.push(whole);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(footprints: &[Footprint]) -> Vec<Window> {
        windows(footprints, Grid::new([1280, 720]), &Workspace::default()).to_vec()
    }

    fn in_cells(grid: Grid, cells: u64) -> Vec<[u32; 4]> {
        let [across, down] = grid.cells();
        let blocks = (0..down).flat_map(|row| (0..across).map(move |column| [column, row, 1, 1]));
        blocks.filter(|block| grid.block(*block) & cells != 0).collect()
    }

    #[test]
    fn every_volume_is_counted_in_each_of_its_cells_and_in_none_twice() {
        let grid = Grid::new([1280, 720]);
        let mut random = 12345u64;
        let mut next = |below: u64| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 33) % below
        };
        for volumes in [1, 2, 5, 40] {
            let footprints: Vec<_> = (0..volumes)
                .map(|_| {
                    let [column, row] = [next(8), next(4)].map(|at| at as u32);
                    let block = [column, row, 1 + next(2) as u32, 1 + next(2) as u32];
                    Footprint::of(grid.block(block), grid.pixels(block), 12 << next(9))
                })
                .collect();
            let windows = found(&footprints);
            let all = footprints.iter().fold(0, |cells, volume| cells | volume.cells);
            let covered = windows.iter().fold(0, |seen, window| {
                assert_eq!(seen & window.cells, 0, "windows do not overlap");
                assert_eq!(grid.pixels(window.block), window.rect);
                seen | window.cells
            });
            assert_eq!(covered & all, all);
        }
    }

    #[test]
    fn far_apart_they_are_counted_apart_and_near_each_other_together() {
        let grid = Grid::new([1280, 720]);
        let at = |block| Footprint::of(grid.block(block), grid.pixels([0, 0, 10, 6]), 12);
        assert_eq!(found(&[at([0, 0, 1, 1]), at([9, 5, 1, 1])]).len(), 2);
        let together = found(&[at([3, 2, 2, 2]), at([3, 2, 2, 2])]);
        assert_eq!(together.len(), 1);
        assert_eq!(in_cells(grid, together[0].cells).len(), 4);
    }

    #[test]
    fn many_triangles_are_met_once() {
        let grid = Grid::new([1280, 720]);
        let dense = Footprint::of(grid.block([0, 0, 1, 1]) | grid.block([3, 3, 1, 1]), grid.pixels([0, 0, 4, 4]), 2_000_000);
        let windows = found(&[dense]);
        assert_eq!(windows.len(), 1);
        assert_eq!(windows[0].rect, [0, 0, 512, 512]);
    }

    #[test]
    fn nothing_needs_no_window() {
        assert!(found(&[]).is_empty());
    }
}
