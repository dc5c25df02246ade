// With one layer, what the ray meets in front is the answer.
Contact first_of_layers(Ray ray, Contact front) { return front; }
Contact first_of_layers(Ray ray, Grid grid, Contact front, crossing t_in, crossing t_out) { return front; }
