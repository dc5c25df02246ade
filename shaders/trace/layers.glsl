// The hit contract in the layers behind the first one, which layers.layered.glsl has. front: what the ray meets in the first layer.
Contact first_of_layers(Ray ray, Contact front) { return front; }
Contact first_of_layers(Ray ray, Grid grid, Contact front, crossing t_in, crossing t_out) { return front; }
