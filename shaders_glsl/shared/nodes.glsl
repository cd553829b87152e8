// Nodes: every `stride`-th grid point along an axis, from the first, and the last.

int node_count(int grid_points, int stride) {
    return (grid_points + stride - 2) / stride + 1;
}

int node_place(int node, int grid_points, int stride) {
    return min(node * stride, grid_points - 1);
}

// Relation to nodes of a stride that is `each` times as wide (every so many nodes, and the last): the i-th of them,
// whether a node is one, and the i-th of the others.
int coarse_node(int i, int count, int each) {
    return min(each * i, count - 1);
}

bool is_coarse(int node, int count, int each) {
    return node % each == 0 || node == count - 1;
}

int other_node(int i, int each) {
    return i + i / (each - 1) + 1;
}

// The node at a grid point that is one.
int node_of(int place, int stride) {
    return (place + stride - 1) / stride;
}
