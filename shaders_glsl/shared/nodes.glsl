// Nodes: every `stride`-th grid point along an axis, from the first, and the last.

int node_count(int grid_points, int stride) {
    return (grid_points + stride - 2) / stride + 1;
}

int node_place(int node, int grid_points, int stride) {
    return min(node * stride, grid_points - 1);
}

// Relation to nodes of twice the stride (every second and the last): the i-th of them, and whether a node is one.
int second_node(int i, int count) {
    return min(2 * i, count - 1);
}

bool is_second(int node, int count) {
    return (node & 1) == 0 || node == count - 1;
}

// The node at a grid point that is one.
int node_of(int place, int stride) {
    return (place + stride - 1) / stride;
}
