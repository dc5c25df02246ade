float held_front(float depth) { return depth; }
