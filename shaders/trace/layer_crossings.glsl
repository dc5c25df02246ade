// first_of_layers() between two crossings.
Contact first_of_layers(Ray ray, Grid grid, Contact front, real t_in, real t_out) { return first_of_layers(ray, front); }
