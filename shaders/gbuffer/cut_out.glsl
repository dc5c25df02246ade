// The material has no alpha mask.
void discard_cut_out() {}
