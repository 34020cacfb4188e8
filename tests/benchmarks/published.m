% The published simulator's rules (the snake that looks at every plant, three viewpoints) in GNU
% Octave: S sides of P faces; a day of driving and looking; a night in which an infested face
% infects, on one coin, those before and after it and the other face of its vine. Prints the
% seconds of a run and the percent of all insects that were found.
function published (P, R, plant_s, severity, runs)
  S = 2 * R - 2;
  T = S * P;
  cost_s = plant_s + 23.74;
  rand ("twister", 1);
  found = 0;
  known = 0;
  began = tic ();
  for run = 1:runs
    vines = rand (R, P) > 0.7;
    rows = floor (((0:S-1) + 1) / 2) + 1;
    infested = reshape (vines(rows, :)', 1, T);
    at = 1;
    known += sum (infested);
    for day = 1:3
      left_s = 7200;
      while left_s - cost_s > 0
        left_s -= cost_s;
        if infested(at)
          infested(at) = false;
          found += 1;
        end
        if mod (at, P) == 0
          left_s -= 25;
        end
        at += 1;
      end
      evening = infested;
      for q = 1:T
        if evening(q) && rand () < severity
          side = floor ((q - 1) / P);
          if q - side * P > 1
            infested(q - 1) = true;
          end
          if q - side * P < P
            infested(q + 1) = true;
          end
          if mod (side, 2) == 1 && side < S - 1
            infested(q + P) = true;
          elseif mod (side, 2) == 0 && side > 0
            infested(q - P) = true;
          end
        end
      end
      known += sum (infested) - sum (evening);
    end
  end
  printf ("%.9f %.4f\n", toc (began) / runs, 100 * found / known);
end
