// Every `stride`-th sample along an axis, from the first, and the last: nodes.

int node_count(int samples, int stride) {
    return (samples + stride - 2) / stride + 1;
}

int node_place(int node, int samples, int stride) {
    return min(node * stride, samples - 1);
}

// Of nodes as many, every second and the last are those of twice the stride: the i-th, and whether a node is one.
int second_node(int i, int count) {
    return min(2 * i, count - 1);
}

bool is_second(int node, int count) {
    return (node & 1) == 0 || node == count - 1;
}

// The node at a sample that is one.
int node_of(int place, int stride) {
    return (place + stride - 1) / stride;
}
