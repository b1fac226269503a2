# Options from the program's own --help, else names of files.
complete -F _longopt mesh_to_stpbv urdf_collision_report find_posture jump_sweep speed_accuracy stability
