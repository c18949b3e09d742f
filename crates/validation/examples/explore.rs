use barrelstack_validation::rocking::*; use barrelstack_validation::theory;
fn main(){
  for alpha in [0.1,0.25,0.4] { println!("alpha {alpha} housner {:.4}", theory::housner_restitution(alpha));
   for corner in [Corner::SpeedGap, Corner::KelvinVoigt] { for n in [2,3,11] { print!("{corner:?} n={n} ");
    for z in [0.07,0.3,0.5,0.7,1.0,3.0,8.0] { let mut b=RockingBlock::new(1.0,alpha); b.corner=corner; b.damping_ratio=z; b.base_nodes=n;
      print!(" {:.4}", b.restitution(0.5).unwrap()); } println!(); } } }
  for (corner) in [Corner::SpeedGap, Corner::KelvinVoigt] { for f in [1500.0,3000.0,6000.0]{ for alpha in [0.1,0.25,0.4] { let mut b=RockingBlock::new(1.605,alpha); b.corner=corner; b.contact_frequency=f;
    let t=std::time::Instant::now(); let c=b.calibrated(theory::housner_restitution(alpha)).unwrap(); 
    print!("{corner:?} f {f} a {alpha}: {:?} ", c.map(|c|c.damping_ratio));
    if let Some(c)=c { for s in [0.1,0.25,0.5,0.75,0.9] { print!(" {:.4}", c.restitution(s).unwrap()/theory::housner_restitution(alpha)); } }
    println!(" {:?}", t.elapsed()); } } }
}
