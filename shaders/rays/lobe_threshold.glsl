const float mirror_roughness = 0.02; // below it a surface is a mirror
