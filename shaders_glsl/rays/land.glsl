// The first push constants of passes whose rays traverse blocks of cells.
struct LandPush {
    int cols;
    int rows;
    int cells_x;
    int cells_y;
    int padded_rows;  // as in bounds.glsl
    int top_level;    // its one block holds all cells
    float cell_x_m;
    float cell_y_m;
};
