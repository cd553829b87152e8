// Every `stride`-th sample along an axis, from the first, and the last: nodes.

int node_count(int samples, int stride) {
    return (samples + stride - 2) / stride + 1;
}

int node_place(int node, int samples, int stride) {
    return min(node * stride, samples - 1);
}

// The node at a sample that is one.
int node_of(int place, int stride) {
    return (place + stride - 1) / stride;
}
