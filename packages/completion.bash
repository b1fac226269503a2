# Options from the program's own --help, else names of files.
complete -F _longopt mesh_to_stpbv urdf_collision_report urdf_to_stpbv find_posture jump_sweep speed_accuracy stability
