//! Rectangles of pixels (x, y, width, height from the top left), and the cells a picture is divided into.

/// The pixels of both rectangles; `None` where there are none.
#[must_use]
pub fn common([ax, ay, aw, ah]: [u32; 4], [bx, by, bw, bh]: [u32; 4]) -> Option<[u32; 4]> {
    let (x, y) = (ax.max(bx), ay.max(by));
    let (right, bottom) = ((ax + aw).min(bx + bw), (ay + ah).min(by + bh));
    (right > x && bottom > y).then(|| [x, y, right - x, bottom - y])
}

/// The smallest rectangle that holds both.
#[must_use]
pub fn around([ax, ay, aw, ah]: [u32; 4], [bx, by, bw, bh]: [u32; 4]) -> [u32; 4] {
    let (x, y) = (ax.min(bx), ay.min(by));
    [x, y, (ax + aw).max(bx + bw) - x, (ay + ah).max(by + bh) - y]
}

/// A picture as at most 64 square cells, so that any set of them is one number: a bit for each, row by row.
///
/// Their sides are multiples of 64 pixels, which is the tile a software rasteriser works in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid {
    size: [u32; 2],
    side: u32,
    across: u32,
    down: u32,
}

impl Grid {
    /// Every cell of any grid.
    pub const ALL: u64 = u64::MAX;

    /// Of a picture of `size`, neither side zero.
    #[must_use]
    pub fn new(size: [u32; 2]) -> Self {
        let mut side = 64;
        while u64::from(size[0].div_ceil(side)) * u64::from(size[1].div_ceil(side)) > 64 {
            side += 64;
        }
        Self { size, side, across: size[0].div_ceil(side), down: size[1].div_ceil(side) }
    }

    /// Columns and rows.
    #[must_use]
    pub const fn cells(&self) -> [u32; 2] {
        [self.across, self.down]
    }

    /// The cells of a block: column, row, columns, rows.
    #[must_use]
    pub const fn block(&self, [column, row, columns, rows]: [u32; 4]) -> u64 {
        let line = (Self::ALL >> (64 - columns)) << column;
        let (mut cells, mut at) = (0, row);
        while at < row + rows {
            cells |= line << (at * self.across);
            at += 1;
        }
        cells
    }

    /// The cells that a rectangle, not empty, reaches into.
    #[must_use]
    pub fn reached_by(&self, [x, y, width, height]: [u32; 4]) -> u64 {
        let [left, top] = [x / self.side, y / self.side];
        let right = ((x + width - 1) / self.side).min(self.across - 1);
        let bottom = ((y + height - 1) / self.side).min(self.down - 1);
        self.block([left, top, right - left + 1, bottom - top + 1])
    }

    /// The pixels of a block.
    #[must_use]
    pub fn pixels(&self, [column, row, columns, rows]: [u32; 4]) -> [u32; 4] {
        let (x, y) = (column * self.side, row * self.side);
        [x, y, (columns * self.side).min(self.size[0] - x), (rows * self.side).min(self.size[1] - y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_meet_and_join() {
        assert_eq!(common([0, 0, 10, 10], [5, 2, 20, 3]), Some([5, 2, 5, 3]));
        assert_eq!(common([0, 0, 10, 10], [10, 0, 5, 5]), None, "they touch");
        assert_eq!(around([2, 3, 1, 1], [5, 0, 2, 2]), [2, 0, 5, 4]);
    }

    #[test]
    fn cells_cover_the_picture_once() {
        for size in [[1, 1], [64, 64], [65, 1], [640, 360], [1280, 720], [3840, 2160], [16384, 3], [511, 4000]] {
            let grid = Grid::new(size);
            let [across, down] = grid.cells();
            assert!(across * down <= 64);
            let (mut area, mut seen) = (0, 0u64);
            for (column, row) in (0..across).flat_map(|column| (0..down).map(move |row| (column, row))) {
                let block = [column, row, 1, 1];
                let pixels = grid.pixels(block);
                area += u64::from(pixels[2]) * u64::from(pixels[3]);
                assert_eq!(grid.block(block).count_ones(), 1);
                assert_eq!(grid.reached_by(pixels), grid.block(block), "{size:?} {block:?}");
                assert_eq!(seen & grid.block(block), 0);
                seen |= grid.block(block);
            }
            assert_eq!(area, u64::from(size[0]) * u64::from(size[1]));
            assert_eq!(grid.reached_by([0, 0, size[0], size[1]]), seen);
            assert_eq!(grid.pixels([0, 0, across, down]), [0, 0, size[0], size[1]]);
        }
    }

    #[test]
    fn a_rectangle_reaches_the_cells_it_has_pixels_in() {
        let grid = Grid::new([1280, 720]);
        assert_eq!(grid.cells(), [10, 6]);
        assert_eq!(grid.reached_by([127, 0, 2, 1]), 0b11);
        assert_eq!(grid.reached_by([128, 128, 128, 128]), 1 << 11);
        assert_eq!(grid.reached_by([1279, 719, 1, 1]), 1 << 59);
    }
}
