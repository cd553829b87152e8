// A block of a level is 4 by 4 blocks of the level below; level 0 are the cells.
const int LEVEL_BITS = 2;

// First row of a level (1 and up) in the image of all levels, which are stacked vertically. With P rows of cells,
// padded to whole blocks of the top level, level l has P / 4^l rows and begins at P/2 - P / (2 4^(l-1)): 0, 3P/8,
// 15P/32 ..., each at or after the end of the one before.
int level_top(int level, int padded_rows) {
    return (padded_rows >> 1) - (padded_rows >> (LEVEL_BITS * level - 1));
}
